# SPDX-License-Identifier: Apache-2.0
# ctest includes this file when it starts. It adds one test per group of suites of `executable`, called `name`.GROUP,
# with `label` and `timeout` (seconds, for each process). One process then runs a whole group, so that its tests share
# a device and pipelines. `groups` holds the names of the groups, each followed by an expression for its suites: a
# suite belongs to the first group that matches. A group of more suites than a process may have becomes several tests,
# called `name`.GROUP1, `name`.GROUP2 and so on. Large groups start first, so that no core waits for one in the end.

# More suites would take more memory: drivers keep some for each pipeline, and all GPU tests in one process took 5.9 GB
# on llvmpipe.
set(suites_of_a_process 30)

if(NOT EXISTS "${executable}")
    add_test(${name}.NOT_BUILT "${executable}")
    set_tests_properties(${name}.NOT_BUILT PROPERTIES LABELS "${label}")
    return()
endif()
execute_process(COMMAND "${executable}" --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
# Comments about parameters may contain anything.
string(REGEX REPLACE " *#[^\n]*" "" listed "${listed}")
string(REGEX MATCHALL "[A-Za-z0-9_/]+\\.\n(  [^\n]*\n)+" suites "${listed}")
while(groups)
    list(POP_FRONT groups group expression)
    set(members)
    set(count 0)
    foreach(suite ${suites})
        string(REGEX REPLACE "\\..*" "" suite_name "${suite}")
        if(suite_name MATCHES "${expression}")
            list(APPEND members ${suite_name})
            list(REMOVE_ITEM suites "${suite}")
            string(REGEX MATCHALL "\n  " tests "${suite}")
            list(LENGTH tests tests)
            math(EXPR count "${count} + ${tests}")
        endif()
    endforeach()
    if(NOT members)
        message(FATAL_ERROR "group ${group} of ${name} has no suites")
    endif()
    # Processes of about equal length, each an entry of its own, so that the cores share them.
    list(LENGTH members suite_count)
    math(EXPR entries "(${suite_count} + ${suites_of_a_process} - 1) / ${suites_of_a_process}")
    math(EXPR cost "${timeout} * ${count} / ${entries}")
    foreach(entry RANGE 1 ${entries})
        math(EXPR first "(${entry} - 1) * ${suite_count} / ${entries}")
        math(EXPR length "${entry} * ${suite_count} / ${entries} - ${first}")
        list(SUBLIST members ${first} ${length} together)
        set(entry_name ${name}.${group})
        if(entries GREATER 1)
            set(entry_name ${name}.${group}${entry})
        endif()
        add_test(${entry_name} "${python}" "${run_suites}" "${executable}" ${together})
        set(limit ${timeout})
        if("$ENV{CANDELABRA_FULL_TESTS}" STREQUAL "1") # each suite has a process of its own
            math(EXPR limit "${timeout} * ${length}")
        endif()
        set_tests_properties(${entry_name} PROPERTIES LABELS "${label}" TIMEOUT ${limit} COST ${cost})
    endforeach()
endwhile()
if(suites)
    message(FATAL_ERROR "no group of ${name} has the suites ${suites}")
endif()
