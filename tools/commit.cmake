# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT, a header with the commit of the checkout in SOURCE, unless it is up to date.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
    set(commit "unknown") # not a git checkout
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#pragma once
namespace candelabra::app
{
constexpr const char* commit = \"${commit}\";
} // namespace candelabra::app
")
