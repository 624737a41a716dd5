// SPDX-License-Identifier: Apache-2.0
// Fuzzes command lines, with one argument per line of input: they are parsed but not run.
#include <sstream>

#include "commands/commands.h"
#include "fuzz/fuzz_target.h"

namespace candelabra::test
{

Seeds fuzzSeeds()
{
    return {"render\nhall\n--lights\n16000\n-o\nhall.png\n--camera\n0,1,2,3,4,5,60\n--size\n64x48",
            "stress\n--lights\n1000,4000\n--size=1280x720\n--json\ns.json",
            "profile\nhall\n--ab\n--specular karis\n--specular conic\n--frames\n30",
            "compare\na.json\nb.json\n--pass\nshade_tiles\n--fail-above\n2",
            "diff\na.exr\nb.exr\n--max-relmse\n1e-6\n-o\nheat.png",
            "view\nfield\n--moving\n--frames\n3",
            "truth\nscene.json\n-o\nt.exr\n--shard\n1/3",
            "bench\naccuracy\n--groups\n20\n--seed\n4",
            "bench\nskip\n--rounds\n3",
            "render\nhall\n--influence-error\n0.5/255\n--pick\n4,5",
            "devices\n--json",
            "report\n--parts\nprofile,culling\n--out\nr",
            "render\n--help"};
}

} // namespace candelabra::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace candelabra::app;
    std::vector<std::string> arguments;
    std::istringstream lines(std::string(data, data + size));
    for (std::string line; std::getline(lines, line);)
        arguments.push_back(line.substr(0, line.find('\0')));
    std::vector<const char*> argv{"candelabra"};
    for (const std::string& argument : arguments)
        argv.push_back(argument.c_str());
    static Run run;
    static CLI::App app("fuzzed"); // created once, because creation takes longer than parsing
    if (app.get_subcommands({}).empty())
        for (const auto add : {addBenchCommand, addCompareCommand, addDevicesCommand,
                               addDiffCommand, addProfileCommand, addRenderCommand,
                               addReportCommand, addStressCommand, addTruthCommand, addViewCommand})
            add(app, run);
    try {
        app.parse(int(argv.size()), argv.data());
    } catch (const CLI::Error&) { // also thrown for --help
    }
    return 0;
}
