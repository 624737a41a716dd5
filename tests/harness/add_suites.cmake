# SPDX-License-Identifier: Apache-2.0
# ctest includes this file when it starts. It adds one test per suite of `executable`, called `name`.SUITE, with
# `label` and `timeout` (seconds). One process then runs a whole suite, so that its tests share a device and pipelines.
# Large suites start first, so that no core waits for one in the end.
if(NOT EXISTS "${executable}")
    add_test(${name}.NOT_BUILT "${executable}")
    return()
endif()
execute_process(COMMAND "${executable}" --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
# Comments about parameters may contain anything.
string(REGEX REPLACE " *#[^\n]*" "" listed "${listed}")
string(REGEX MATCHALL "[A-Za-z0-9_/]+\\.\n(  [^\n]*\n)+" suites "${listed}")
foreach(suite ${suites})
    string(REGEX MATCHALL "\n  " tests "${suite}")
    list(LENGTH tests count)
    string(REGEX REPLACE "\\..*" "" suite "${suite}")
    add_test(${name}.${suite} "${python}" "${run_suite}" "${executable}" ${suite})
    math(EXPR cost "${timeout} * ${count}")
    set_tests_properties(${name}.${suite} PROPERTIES LABELS "${label}" TIMEOUT ${timeout} COST ${cost})
endforeach()
