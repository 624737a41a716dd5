// SPDX-License-Identifier: Apache-2.0
// Searches for the constants with Subplex (Rowan 1990) of the library NLopt: the method of Nelder
// and Mead in changing subspaces, which needs no derivative. The objective has none, because maxima
// and percentiles are part of it; its constants depend on each other, and along some combinations
// of them it hardly changes.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <nlopt.h>

#include "fit/commands.h"
#include "generate/random.h"
#include "io/error.h"
#include "io/report.h"
#include "render/provenance.h"

namespace candelabra::fit
{
namespace
{

using app::Json;

// Constants are searched as the logarithm of their factor on the committed ones, because they are
// positive and of different sizes, within +-1.2 (0.3 to 3.3 times).
constexpr double bound = 1.2, firstStep = 0.1;
using Factors = std::vector<double>;

Factors upperBounds()
{
    Factors out;
    for (const ConicConstant& c : conicConstants())
        out.push_back(std::min(bound, std::log(0.99 * c.limit / c.committed)));
    return out;
}

ConicConstants constantsAt(const double* logFactors)
{
    ConicConstants out;
    for (size_t i = 0; i < conicConstants().size(); ++i) {
        const ConicConstant& c = conicConstants()[i];
        out.*c.value = c.committed * std::exp(logFactors[i]);
    }
    return out;
}

struct Search {
    std::string start;
    double startCost = 0, cost = 0;
    uint32_t evaluations = 0;
    ConicConstants constants;
};

struct Progress {
    const ConicObjective& objective;
    nlopt_opt optimiser;
    uint32_t evaluations = 0;
    double best = std::numeric_limits<double>::infinity();
    std::exception_ptr failure; // what an evaluation threw: exceptions must not pass through C code
};

double evaluate(unsigned, const double* logFactors, double*, void* data)
{
    Progress& progress = *static_cast<Progress*>(data);
    try {
        const double cost = progress.objective.cost(constantsAt(logFactors));
        progress.best = std::min(progress.best, cost);
        if (++progress.evaluations % 500 == 0)
            fmt::print(stderr, "  {} evaluations, cost {:.4f}\n", progress.evaluations,
                       progress.best);
        return std::isfinite(cost) ? cost : 1e9;
    } catch (...) {
        progress.failure = std::current_exception();
        nlopt_force_stop(progress.optimiser);
        return 1e9;
    }
}

Search search(const ConicObjective& objective, const std::string& start, Factors at,
              uint32_t evaluations)
{
    Search out{.start = start, .startCost = objective.cost(constantsAt(at.data()))};
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(
        nlopt_create(NLOPT_LN_SBPLX, unsigned(at.size())), nlopt_destroy);
    if (!optimiser)
        throw app::RunError("NLopt could not make its optimiser");
    Progress progress{.objective = objective, .optimiser = optimiser.get()};
    fmt::print(stderr, "searching from {} constants ...\n", start);
    nlopt_set_min_objective(optimiser.get(), evaluate, &progress);
    nlopt_set_lower_bounds1(optimiser.get(), -bound);
    nlopt_set_upper_bounds(optimiser.get(), upperBounds().data());
    nlopt_set_initial_step1(optimiser.get(), firstStep);
    nlopt_set_xtol_rel(optimiser.get(), 1e-5);
    nlopt_set_ftol_rel(optimiser.get(), 1e-8);
    nlopt_set_maxeval(optimiser.get(), int(evaluations));
    const nlopt_result result = nlopt_optimize(optimiser.get(), at.data(), &out.cost);
    if (progress.failure)
        std::rethrow_exception(progress.failure);
    if (result < 0 && result != NLOPT_ROUNDOFF_LIMITED)
        throw app::RunError(fmt::format("NLopt failed: {}", nlopt_result_to_string(result)));
    out.evaluations = progress.evaluations;
    out.constants = constantsAt(at.data());
    return out;
}

Json toJson(const ErrorFigures& f)
{
    return {{"meanPercent", f.mean},
            {"rmsPercent", f.rms},
            {"p99Percent", f.p99},
            {"maxPercent", f.largest}};
}

Json toJson(const MethodFigures& f)
{
    return {
        {"fresnel1", {{"all", toJson(f.mirror.all)}, {"above", toJson(f.mirror.above)}}},
        {"F0_0.04", {{"all", toJson(f.dielectric.all)}, {"above", toJson(f.dielectric.above)}}}};
}

Json toJson(const ConicResiduals& r)
{
    return {{"conic", toJson(r.conic)}, {"conic-full", toJson(r.conicFull)}};
}

Json toJson(const ConicConstants& constants)
{
    Json out;
    for (const ConicConstant& c : conicConstants())
        out[c.name] = std::stod(fmt::format("{}", float(constants.*c.value))); // as shaders hold it
    return out;
}

// Prints the cost and the residuals of `constants` on a set of groups, and returns them for the
// record.
Json report(const std::string& name, const ConicObjective& objective,
            const ConicConstants& constants)
{
    const ConicResiduals r = objective.residuals(constants);
    const double cost = objective.cost(constants);
    fmt::print("  {:<34}{:8.3f}", name, cost);
    const char* indent = "";
    for (const auto& [method, figures] :
         {std::pair{"conic", &r.conic}, {"conic-full", &r.conicFull}}) {
        fmt::print("{}  {:<10}", indent, method);
        for (const ErrorFigures& f : {figures->mirror.all, figures->dielectric.all})
            fmt::print("  {:7.4f}{:7.3f}{:6.2f}{:8.2f}", f.mean, f.rms, f.p99, f.largest);
        fmt::print("\n");
        indent = "                                            ";
    }
    std::fflush(stdout);
    return {{"cost", cost}, {"residuals", toJson(r)}};
}

void printHead()
{
    fmt::print("\nErrors in percent of the highest response of their group:\n"
               "  {:<34}{:>8}  {:<10}  {:<28}  {:<28}\n",
               "", "", "", "  F0 = 1", "  F0 = 0.04");
    fmt::print("  {:<34}{:>8}  {:<10}", "constants, groups", "cost", "method");
    for (int i = 0; i < 2; ++i)
        fmt::print("  {:>7}{:>7}{:>6}{:>8}", "mean", "rms", "p99", "largest");
    fmt::print("\n");
}

void printConstants(const std::vector<Search>& searches)
{
    fmt::print("\n{:<28}{:>10}", "constant", "committed");
    for (const Search& s : searches)
        fmt::print("  {:>18}", "from " + s.start);
    for (const ConicConstant& c : conicConstants()) {
        fmt::print("\n{:<28}{:>10.4f}", c.name, c.committed);
        for (const Search& s : searches)
            fmt::print("  {:>10.4f}{:>+7.1f}%", s.constants.*c.value,
                       100 * (s.constants.*c.value / c.committed - 1));
        fmt::print("  {}", c.meaning);
    }
    fmt::print("\n");
}

Factors badStart(double perturbation, uint64_t seed)
{
    app::Random random(seed);
    Factors out = upperBounds();
    for (double& x : out)
        x = std::min(x, perturbation * double(random.uniform(-1, 1)));
    return out;
}

// The groups to which the constants are fitted, and groups that no fit sees.
struct Groups {
    ConicObjective training, heldOut;
};

Groups integrate(const ConicSettings& s)
{
    fmt::print("integrating {} groups of {} directions ...\n",
               s.training.groups + s.training.others + s.heldOut, app::samplesPerGroup);
    std::fflush(stdout);
    return {ConicObjective(drawTrainingSamples(s.training)),
            ConicObjective(drawSamples(s.heldOut, s.training.seed + 2))};
}

Json reportBoth(const std::string& name, const Groups& groups, const ConicConstants& constants)
{
    return {{"constants", toJson(constants)},
            {"training", report(name + ", training", groups.training, constants)},
            {"heldOut", report(name + ", held out", groups.heldOut, constants)}};
}

std::vector<Search> searchFromAll(const ConicSettings& s, const ConicObjective& training)
{
    std::vector<Search> out;
    if (s.evaluations == 0)
        return out;
    out.push_back(search(training, "committed", Factors(conicConstants().size()), s.evaluations));
    if (s.perturbation > 0)
        out.push_back(
            search(training, "bad", badStart(s.perturbation, s.training.seed), s.evaluations));
    return out;
}

} // namespace

void runConic(const ConicSettings& s, const std::string& commandLine)
{
    if (s.training.hard > s.training.others)
        throw app::UsageError(fmt::format("--hard {} asks for more groups than --others {} has",
                                          s.training.hard, s.training.others));
    if (!s.json.empty())
        app::requireWritable("--json", s.json);
    const Groups groups = integrate(s);
    const std::vector<Search> searches = searchFromAll(s, groups.training);

    printHead();
    const Json committed = reportBoth("committed", groups, {});
    Json found = Json::array();
    for (const Search& run : searches) {
        Json json{
            {"start", run.start}, {"startCost", run.startCost}, {"evaluations", run.evaluations}};
        json.update(reportBoth("from " + run.start, groups, run.constants));
        found.push_back(std::move(json));
    }
    for (const Search& run : searches)
        fmt::print("\nfrom {}: cost {:.4f} -> {:.4f} in {} evaluations", run.start, run.startCost,
                   run.cost, run.evaluations);
    printConstants(searches);
    if (s.json.empty())
        return;
    const ConicObjective check(drawCheckSamples());
    app::writeJson(
        s.json, {{"provenance", app::provenance(commandLine)},
                 {"groups",
                  {{"training", s.training.groups},
                   {"hard", s.training.hard},
                   {"others", s.training.others},
                   {"heldOut", s.heldOut},
                   {"seed", s.training.seed}}},
                 {"perturbation", s.perturbation},
                 {"committed", committed},
                 {"check", {{"cost", check.cost({})}, {"residuals", toJson(check.residuals({}))}}},
                 {"searches", found}});
    fmt::print("wrote {}\n", s.json);
}

} // namespace candelabra::fit
