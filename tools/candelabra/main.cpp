// SPDX-License-Identifier: Apache-2.0
#include "cli.h"
#include "io/interrupts.h"

int main(int argc, char** argv)
{
    candelabra::app::cleanUpOnSignals();
    return candelabra::app::runProgram(argc, argv);
}
