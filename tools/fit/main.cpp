// SPDX-License-Identifier: Apache-2.0
// candelabra_fit computes the fitted numbers that the shaders contain. It is not built by default.
#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

#include "fit/commands.h"
#include "fit/point_sets.h"
#include "io/error.h"
#include "io/report.h"

using namespace candelabra;

namespace
{

void describeConic(CLI::App& app, fit::ConicSettings& s)
{
    CLI::App* conic =
        app.add_subcommand("conic", "Fit the constants of the closed form of sphere lights "
                                    "(shaders/shared/conic_constants.h) to the truth");
    conic->footer(
        "The truth is integrated in double precision. A group of samples is one roughness, one\n"
        "view direction and one light size, with the light in 89 directions. An error is given in\n"
        "percent of the highest true response of its group.\n\n"
        "Prints the errors of the constants that the shaders have, on the groups that are fitted\n"
        "to and on others that are not, then the constants that two searches find, with their\n"
        "errors: one search starts from the shaders' constants, the other from bad ones. Shaders\n"
        "are not changed; whoever adopts new constants edits the header, and commits the tables\n"
        "that tools/update_results --import FILE makes of the record (--json FILE). Takes some "
        "five\n"
        "minutes of CPU time.\n\n"
        "Examples:\n"
        "  candelabra_fit conic --json out/fit.json\n"
        "  candelabra_fit conic --evaluations 0      errors of the shaders' constants, no search\n"
        "  candelabra_fit conic --groups 40 --others 40 --hard 2 --held-out 40 --evaluations 100\n"
        "                                            a search that is over in seconds");
    const CLI::Range groups(1, 100000);
    conic->add_option("--groups", s.training.groups, "number of random groups to fit to")
        ->check(groups)
        ->capture_default_str();
    conic
        ->add_option("--hard", s.training.hard,
                     "number of hard groups to fit to in addition: the shaders' constants have "
                     "their largest errors there")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    conic
        ->add_option("--others", s.training.others,
                     "number of random groups from which the hard groups are chosen")
        ->check(groups)
        ->capture_default_str();
    conic
        ->add_option("--held-out", s.heldOut,
                     "number of random groups that are not fitted to; errors are given for them")
        ->check(groups)
        ->capture_default_str();
    conic
        ->add_option("--seed", s.training.seed,
                     "seed of the random numbers; the same seed gives the same groups and the same "
                     "bad start")
        ->capture_default_str();
    conic
        ->add_option("--evaluations", s.evaluations,
                     "largest number of evaluations per search; 0 means no search")
        ->check(CLI::Range(0, 10000000))
        ->capture_default_str();
    conic
        ->add_option(
            "--perturbation", s.perturbation,
            "P: the bad start multiplies each constant by exp(P u) with a random u from -1 "
            "to 1; 0 means no search from a bad start")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    conic->add_option("--json", s.json, "file to write all results to, as JSON");
}

void describePoints(CLI::App& app, uint32_t& moves)
{
    CLI::App* points =
        app.add_subcommand("points", "Place the points of lights for which shadows are found, and "
                                     "print shaders/shared/visibility_points.h");
    points->add_option("--moves", moves, "tried moves per set of points")
        ->check(CLI::Range(1000u, 1000000000u))
        ->capture_default_str();
    points->callback([&moves] { std::fputs(fit::visibilityPointsHeader(moves).c_str(), stdout); });
}

int printError(int exitCode, const char* sentence)
{
    std::fprintf(stderr, "candelabra_fit: %s\n", sentence);
    return exitCode;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App app{"Computes the fitted numbers that the shaders contain."};
    app.require_subcommand(1);
    fit::ConicSettings conic;
    describeConic(app, conic);
    uint32_t moves = 3000000;
    describePoints(app, moves);
    try {
        app.parse(argc, argv);
        if (app.got_subcommand("conic"))
            fit::runConic(conic, app::commandLine(argc, argv, "candelabra_fit"));
        return app::exitOk;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? app::exitOk : app::exitUsage;
    } catch (const app::UsageError& error) {
        return printError(app::exitUsage, error.what());
    } catch (const std::exception& error) {
        return printError(app::exitFailed, error.what());
    }
}
