// SPDX-License-Identifier: Apache-2.0
// candelabra diff: says whether a picture is the same as another one, and how much it differs.

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "io/error.h"
#include "io/report.h"
#include "io/table.h"
#include "measure/accuracy/picture_difference.h"

namespace candelabra::app
{
namespace
{

struct DiffArguments {
    std::string a, b, output, json;
    std::string maxRelMse = "0";
};

Image loadLinear(const std::string& path)
{
    Image image = loadImageByExtension(path);
    for (const std::string& warning : image.warnings)
        spdlog::warn("warning: {}", warning);
    if (image.channels == 3)
        return image;
    Image out{.width = image.width, .height = image.height, .channels = 3};
    for (const float grey : image.pixels)
        out.pixels.insert(out.pixels.end(), 3, grey);
    return out;
}

// Returns the values of a picture with 3 channels.
Image loadPicture(const std::string& path)
{
    try {
        if (!isDisplayName(path))
            return loadLinear(path);
        const DisplayImage picture = loadPng(path);
        Image out{.width = picture.width, .height = picture.height, .channels = 3};
        for (const glm::vec3& p : picture.pixels)
            out.pixels.insert(out.pixels.end(), {p.x, p.y, p.z});
        return out;
    } catch (const ImageError& error) {
        throw UsageError(error.what());
    }
}

void requireComparable(const DiffArguments& args)
{
    for (const std::string& path : {args.a, args.b})
        if (!isPictureName(path))
            throw UsageError(fmt::format(
                "diff: {}: a picture is a .png, .exr, .hdr or .pfm{}", path,
                lowerExtension(path) == ".json" ? "; candelabra compare compares profiled runs"
                                                : ""));
    if (isDisplayName(args.a) != isDisplayName(args.b))
        throw UsageError(fmt::format(
            "diff: {} holds values of a display and {} linear radiance, which cannot be compared; "
            "give two .png files, or two of .exr, .hdr and .pfm",
            isDisplayName(args.a) ? args.a : args.b, isDisplayName(args.a) ? args.b : args.a));
    if (!args.output.empty()) {
        if (!isDisplayName(args.output))
            throw UsageError("-o " + args.output + ": the name of a heat map must end in .png");
        requireWritable("-o", args.output);
    }
    if (!args.json.empty())
        requireWritable("--json", args.json);
    for (const std::string& path : {args.a, args.b}) {
        requireOther("-o", args.output, path);
        requireOther("--json", args.json, path);
    }
}

// The answer as one sentence.
std::string answer(const DiffArguments& args, const PictureDifference& d, double maxRelMse)
{
    if (d.sameBits)
        return fmt::format("The same, bit for bit: every value of {} is that of {}.", args.a,
                           args.b);
    if (!d.pixels)
        return fmt::format("The same: every value of {} is that of {}, except for signs of zeros "
                           "or bits of NaN.",
                           args.a, args.b);
    const std::string differing = fmt::format("{} of {} ({:.3g}%) differ", grouped(d.pixels),
                                              counted(d.errors.size(), "pixel"),
                                              100 * double(d.pixels) / double(d.errors.size()));
    if (d.notFinitePixels)
        return fmt::format("Different: {}, and {} of them because they are NaN or infinite; relMSE "
                           "of the others is {}.",
                           differing, grouped(d.notFinitePixels), threeDigits(d.relMse));
    const bool within = d.relMse <= maxRelMse;
    return fmt::format("{}: {}; relMSE is {}, {} {:g} (--max-relmse).",
                       within ? "Within the limit" : "Different", differing, threeDigits(d.relMse),
                       within ? "at most" : "above", maxRelMse);
}

constexpr const char* channelNames[] = {"red", "green", "blue"};

// The figures of pictures that differ.
std::string figures(const DiffArguments& args, const PictureDifference& d, double flip)
{
    const LargestDifference& most = d.largest;
    const bool png = isDisplayName(args.a);
    const double scale = png ? 255 : 1;
    const std::string unit =
        fmt::format("{}{}", channelNames[most.channel], png ? " (of 255)" : "");
    Table table({"figure", "value"});
    table.add({"relMSE", threeDigits(d.relMse)});
    table.add({"relative error, mean", threeDigits(d.meanRel)});
    table.add({"relative error, 99th percentile", threeDigits(d.p99Rel)});
    table.add({"FLIP, mean", fmt::format("{:.4f}", flip)});
    table.add({"largest difference at x, y", fmt::format("{}, {}", most.x, most.y)});
    table.add({"A there, " + unit, fmt::format("{:.6g}", scale * most.a)});
    table.add({"B there, " + unit, fmt::format("{:.6g}", scale * most.b)});
    if (!png)
        table.note("FLIP is that of the pictures on a display, with the exposure of B.");
    table.note("The relative error of a value is |A - B| / sqrt(B^2 + (0.1 mean of B)^2), and "
               "relMSE is the mean of its squares.");
    return table.text();
}

std::string notFiniteText(const DiffArguments& args, const PictureDifference& d)
{
    if (!d.notFiniteA && !d.notFiniteB)
        return "";
    return fmt::format("{} of {} and {} of {} are NaN or infinite. The figures leave them out, and "
                       "FLIP takes them for black.\n",
                       counted(d.notFiniteA, "pixel"), args.a, grouped(d.notFiniteB), args.b);
}

void saveErrorMap(const std::string& path, const PictureDifference& d, const Image& image)
{
    const Legend map = errorMap(d.errors, image.width, image.height);
    std::vector<uint8_t> rgb;
    for (const uint32_t pixel : map.pixels)
        for (int i = 0; i < 3; ++i)
            rgb.push_back(uint8_t(pixel >> (8 * i)));
    savePng(path, map.width, map.height, rgb);
    spdlog::info("wrote {}", path);
}

Json diffJson(const ProgramContext& program, const DiffArguments& args, const Image& b,
              const PictureDifference& d, double flip, double maxRelMse, bool beyond)
{
    const LargestDifference& most = d.largest;
    return {{"schema", "candelabra diff 1"},
            {"commandLine", program.commandLine},
            {"a", args.a},
            {"b", args.b},
            {"values", isDisplayName(args.a) ? "display" : "linear"},
            {"widthPixels", b.width},
            {"heightPixels", b.height},
            {"sameBits", d.sameBits},
            {"differingPixels", d.pixels},
            {"notFinite",
             {{"aPixels", d.notFiniteA},
              {"bPixels", d.notFiniteB},
              {"differingPixels", d.notFinitePixels}}},
            {"relMse", d.relMse},
            {"meanRel", d.meanRel},
            {"p99Rel", d.p99Rel},
            {"flip", flip},
            {"largest",
             {{"x", most.x},
              {"y", most.y},
              {"channel", channelNames[most.channel]},
              {"a", most.a},
              {"b", most.b}}},
            {"maxRelMse", maxRelMse},
            {"beyond", beyond}};
}

int diff(const ProgramContext& program, const DiffArguments& args)
{
    const double maxRelMse = numberOption("--max-relmse", args.maxRelMse, 0, 1e30);
    requireComparable(args);
    const Image a = loadPicture(args.a), b = loadPicture(args.b);
    if (a.width != b.width || a.height != b.height)
        throw UsageError(fmt::format("diff: {} has {}x{} pixels and {} {}x{}, which cannot be "
                                     "compared",
                                     args.a, a.width, a.height, args.b, b.width, b.height));
    const PictureDifference d = pictureDifference(a, b);
    const double flip = d.pixels ? pictureFlip(a, b, !isDisplayName(args.a)) : 0;
    const bool beyond = d.notFinitePixels || !(d.relMse <= maxRelMse);
    if (args.json != "-")
        writeText("-", answer(args, d, maxRelMse) + "\n" +
                           (d.pixels ? figures(args, d, flip) : "") + notFiniteText(args, d));
    if (!args.output.empty())
        saveErrorMap(args.output, d, a);
    if (!args.json.empty())
        writeJson(args.json, diffJson(program, args, b, d, flip, maxRelMse, beyond));
    return beyond ? exitBeyond : exitOk;
}

} // namespace

void addDiffCommand(CLI::App& app, Run& run)
{
    CLI::App* command =
        app.add_subcommand("diff", "Say whether a picture is the same as another one");
    const auto a = argumentsOf(*command, run, diff);
    command->add_option("A", a->a, "the picture to test: .png, or linear .exr, .hdr or .pfm")
        ->required();
    command->add_option("B", a->b, "the picture that it should be, of the same kind")->required();
    addOption(*command, "--max-relmse", a->maxRelMse, "X",
              "the largest relMSE with which the pictures count as the same");
    addOption(*command, "-o,--output", a->output, "FILE",
              "PNG file for a map of the relative error, with a legend from 0.01% or less to 100% "
              "or more; equal pixels are black");
    addOption(*command, "--json", a->json, "FILE",
              "JSON file with all figures; - is standard output");
    command->footer(
        "The exit code is 0 if the pictures are the same, or if their relMSE is at most\n"
        "--max-relmse. It is 3 if they are different, and 2 if they cannot be compared. A pixel\n"
        "that is NaN or infinite in one picture is different unless it is the same in the\n"
        "other, whatever the limit.\n\n"
        "Values of .png are compared as a display gets them. Values of the other formats are\n"
        "linear. .hdr keeps 8 bits of a value, so it differs from .exr by up to 0.8%. Grey is\n"
        "RGB with three equal values. FLIP (Andersson et al. 2020) is the difference that a\n"
        "viewer sees, 0 to 1, at 67 pixels per degree. Linear pictures are displayed for it with\n"
        "the exposure that is metered on B, and with the tone map neutral. Automatic exposure\n"
        "makes .png files of two methods or settings differ everywhere: give both the same\n"
        "--exposure, or compare .exr files.\n\n"
        "Examples:\n"
        "  candelabra diff new.png old.png\n"
        "  candelabra diff hall.exr reference/hall.exr --max-relmse 1e-6 -o heat.png");
}

} // namespace candelabra::app
