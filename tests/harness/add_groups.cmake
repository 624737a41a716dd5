# SPDX-License-Identifier: Apache-2.0
# ctest includes this file when it starts. It adds one test per group of suites of `executable`, called `name`.GROUP,
# with `label` and `timeout` (seconds, for each process). One process then runs a whole group, so that its tests share
# a device and pipelines. `groups` holds the names of the groups, each followed by an expression for its suites: a
# suite belongs to the first group that matches. Large groups start first, so that no core waits for one in the end.
if(NOT EXISTS "${executable}")
    add_test(${name}.NOT_BUILT "${executable}")
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
    add_test(${name}.${group} "${python}" "${run_suites}" "${executable}" ${members})
    math(EXPR cost "${timeout} * ${count}")
    set(limit ${timeout})
    if("$ENV{CANDELABRA_FULL_TESTS}" STREQUAL "1") # each suite has a process of its own
        list(LENGTH members processes)
        math(EXPR limit "${timeout} * ${processes}")
    endif()
    set_tests_properties(${name}.${group} PROPERTIES LABELS "${label}" TIMEOUT ${limit} COST ${cost})
endwhile()
if(suites)
    message(FATAL_ERROR "no group of ${name} has the suites ${suites}")
endif()
