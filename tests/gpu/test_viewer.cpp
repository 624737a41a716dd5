// SPDX-License-Identifier: Apache-2.0
// Tests the viewer under Xvfb, with keys and mouse driven by xdotool, and that it shows what
// `candelabra render` draws.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <random>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stb_image.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/full_tests.h"
#include "harness/paths.h"
#include "io/image.h"
#include "load/load.h"
#include "viewer/keys.h"

namespace
{

struct Shot {
    int width = 0, height = 0;
    double left = 0, right = 0; // means of the halves of the image, 0..255

    double mean() const { return (left + right) / 2; }
};

Shot readShot(const std::filesystem::path& path)
{
    Shot out;
    int channels = 0;
    unsigned char* pixels = stbi_load(path.c_str(), &out.width, &out.height, &channels, 3);
    if (!pixels)
        return out;
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
            for (int c = 0; c < 3; ++c)
                (x < out.width / 2 ? out.left : out.right) += pixels[(y * out.width + x) * 3 + c];
    stbi_image_free(pixels);
    out.left /= out.width / 2 * out.height * 3.0;
    out.right /= (out.width - out.width / 2) * out.height * 3.0;
    return out;
}

std::string textOf(const std::filesystem::path& path)
{
    std::stringstream content;
    content << std::ifstream(path).rdbuf();
    return content.str();
}

void requireTools()
{
    for (const char* tool : {"xvfb-run", "xdotool"})
        ASSERT_EQ(std::system((std::string("command -v ") + tool + " >/dev/null").c_str()), 0)
            << tool << " is not installed (tools/setup installs it)";
}

std::filesystem::path emptyFolder(const char* name)
{
    const std::filesystem::path dir =
        std::filesystem::temp_directory_path() / (name + std::to_string(getpid()));
    std::filesystem::create_directories(dir);
    return dir;
}

// Runs a script of tests/data in `dir` and returns its exit code. A validation message, also one
// about leaked objects, makes it 1.
int runSession(const char* script, const std::filesystem::path& dir)
{
    using namespace candelabra::test;
    const std::string command = "cd '" + dir.string() + "' && PROGRAM=" + programWord() +
                                " xvfb-run -a bash " + shellWord(dataPath(script)) +
                                " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Viewer, IsDrivenByKeysAndMouse)
{
    using namespace candelabra::test;
    ASSERT_NO_FATAL_FAILURE(requireTools());
    const std::filesystem::path dir = emptyFolder("candelabra_viewer_");
    const int status = runSession("viewer_session.sh", dir);
    const std::string err = textOf(dir / "err.txt");
    EXPECT_EQ(status, 0) << err;

    Shot shots[9];
    for (int i = 1; i <= 8; ++i)
        shots[i] = readShot(dir / ("candelabra-00" + std::to_string(i) + ".png"));
    EXPECT_EQ(shots[1].width, 320);
    EXPECT_EQ(shots[1].height, 200);
    EXPECT_GT(shots[1].mean(), 5);
    EXPECT_GT(shots[2].mean(), shots[1].mean() + 1); // with fixed exposure one more light is
                                                     // brighter
    EXPECT_NEAR(shots[3].mean(), shots[1].mean(), 0.1);
    EXPECT_GT(std::abs(shots[4].left - shots[1].left) + std::abs(shots[4].right - shots[1].right),
              0.1);
    EXPECT_NEAR(shots[6].mean(), shots[5].mean(), 0.5); // brute force shows the same as clusters
    EXPECT_EQ(shots[8].width, 260);
    EXPECT_EQ(shots[8].height, 180);

    // A bulb was added at the floor, as far as it gives 0.35 lx (a hundredth of what EV100 4 means
    // for a grey card). The mouse dragged it up, and nowhere else.
    std::smatch from, to, reach;
    ASSERT_TRUE(std::regex_search(err, reach, std::regex("added: .*, influence radius (.*) m")));
    EXPECT_NEAR(std::stod(reach[1]), 13.5, 0.051);
    const std::string place = " sphere at (.*), (.*), (.*) m, ";
    ASSERT_TRUE(std::regex_search(err, from, std::regex("light 40 added:" + place))) << err;
    ASSERT_TRUE(std::regex_search(err, to, std::regex("light 40 moved:" + place))) << err;
    EXPECT_EQ(from[1], to[1]);
    EXPECT_NEAR(std::stod(from[2]), 0.05, 0.02);
    EXPECT_GT(std::stod(to[2]), std::stod(from[2]) + 0.1);
    EXPECT_EQ(from[3], to[3]);

    // A pixel was picked: it shows a surface, and the sum of its lights is the pixel.
    const size_t at = err.find("pixel 130,150 at (");
    ASSERT_NE(at, std::string::npos) << err;
    const size_t differs = err.find("the sum differs by ", at);
    ASSERT_NE(differs, std::string::npos) << err;
    const std::string pixel = err.substr(err.find("the pixel: ", at) + 11);
    EXPECT_LE(std::stod(err.substr(differs + 19)), 1e-5 * std::stod(pixel)) << err;

    // A scene was saved: the rooms with their lights as they are now, which can be loaded and
    // rendered.
    using namespace candelabra;
    const std::string saved = (dir / "candelabra-010.json").string();
    const app::Scene scene = app::loadScene(saved, {}),
                     rooms = app::loadScene("rooms", {.lights = 80});
    EXPECT_EQ(scene.lights.size(), rooms.lights.size());
    EXPECT_EQ(scene.instances.size(), rooms.instances.size());
    EXPECT_NE(scene.cameras[0].position, rooms.cameras[0].position);
    if (!HasFailure())
        std::filesystem::remove_all(dir);
}

using candelabra::app::KeyAction;
using candelabra::app::KeyBinding;

// The xdotool command that presses a key of the viewer's table.
std::string pressed(const KeyBinding& binding)
{
    const std::map<int, std::string> names = {
        {GLFW_KEY_TAB, "Tab"},       {GLFW_KEY_DELETE, "Delete"},
        {GLFW_KEY_UP, "Up"},         {GLFW_KEY_DOWN, "Down"},
        {GLFW_KEY_LEFT, "Left"},     {GLFW_KEY_RIGHT, "Right"},
        {GLFW_KEY_PAGE_UP, "Prior"}, {GLFW_KEY_PAGE_DOWN, "Next"},
        {GLFW_KEY_COMMA, "comma"},   {GLFW_KEY_PERIOD, "period"},
        {GLFW_KEY_MINUS, "minus"},   {GLFW_KEY_EQUAL, "equal"},
        {GLFW_KEY_ESCAPE, "Escape"}, {GLFW_KEY_LEFT_BRACKET, "bracketleft"},
        {GLFW_KEY_F1, "F1"},         {GLFW_KEY_RIGHT_BRACKET, "bracketright"},
        {GLFW_KEY_F2, "F2"},         {GLFW_KEY_F5, "F5"},
        {GLFW_KEY_F11, "F11"},       {GLFW_KEY_HOME, "Home"}};
    std::string out = "key ";
    if (binding.modifiers & GLFW_MOD_CONTROL)
        out += "ctrl+";
    if (binding.modifiers & GLFW_MOD_SHIFT)
        out += "shift+";
    if (binding.key >= GLFW_KEY_A && binding.key <= GLFW_KEY_Z)
        return out + char('a' + binding.key - GLFW_KEY_A);
    return out + names.at(binding.key);
}

std::vector<KeyBinding> allBindings()
{
    std::vector<KeyBinding> out;
    for (const auto& help : candelabra::app::keyHelp)
        for (const KeyBinding& binding : help.bindings)
            if (binding.action != KeyAction::None)
                out.push_back(binding);
    return out;
}

// Random inputs: keys of the table, clicks, drags and turns of the wheel, clicks with Ctrl (a
// field of the panel is typed into then) and keys that matter in a field. What would end the
// session is left out, and so is most of what takes long.
std::string randomInputs(uint32_t seed)
{
    std::mt19937 random(seed);
    const auto below = [&](uint32_t n) { return uint32_t(random() % n); };
    const std::vector<KeyBinding> bindings = allBindings();
    const char* const typed[] = {"5", "7", "BackSpace", "Return", "End", "ctrl+a"};
    // Counts the presses of slow keys, and of those after which much is in view. Two presses of
    // each are enough.
    std::map<KeyAction, int> slow{{KeyAction::FewerLights, 0},  {KeyAction::MoreLights, 0},
                                  {KeyAction::SaveRadiance, 0}, {KeyAction::SaveScene, 0},
                                  {KeyAction::ListLights, 0},   {KeyAction::Compare, 0},
                                  {KeyAction::NextSpecular, 0}, {KeyAction::Culling, 0},
                                  {KeyAction::Home, 0},         {KeyAction::FrameScene, 0}};
    std::string out;
    const int count = candelabra::test::fullTests() ? 500 : 200;
    for (int i = 0; i < count;) {
        const std::string place = std::to_string(below(240)) + " " + std::to_string(below(160));
        ++i;
        switch (below(9)) {
        case 0:
            out += "mousemove " + place + " click 1\n";
            break;
        case 1:
            out += "keydown ctrl mousemove " + place + " click 1 keyup ctrl\n";
            break;
        case 2:
            out += "mousedown 1 mousemove " + place + " mouseup 1\n";
            break;
        case 3:
            out += std::string("key ") + typed[below(std::size(typed))] + "\n";
            break;
        case 4:
            out += "click " + std::to_string(3 + below(3)) + "\n";
            break;
        case 5: // opens and closes the panel, which is collapsed in a small window
            out += "mousemove 16 16 click 1\n";
            break;
        default: {
            const KeyBinding& binding = bindings[below(uint32_t(bindings.size()))];
            if (binding.action == KeyAction::Quit || binding.action == KeyAction::FullScreen ||
                binding.action == KeyAction::SaveImage ||
                (slow.contains(binding.action) && ++slow.at(binding.action) > 2))
                --i; // another one in its place
            else
                out += pressed(binding) + "\n";
        }
        }
    }
    return out;
}

struct KeyCheck {
    KeyAction action;
    const char* expected; // a regular expression for a line that the viewer prints then
    int tries = 1;        // how often the key is pressed until then
    const char* before = "";
};

// In an order in which every key can have its effect.
constexpr KeyCheck keyChecks[] = {
    {KeyAction::NextLight, "^light [0-9]+ selected: "},
    {KeyAction::PreviousLight, "^light [0-9]+ selected: "},
    {KeyAction::FrameScene, "^the camera is inside the scene$"},
    {KeyAction::AddLight, "^light [0-9]+ added: sphere at "},
    {KeyAction::DuplicateLight, "^light [0-9]+ added: sphere at "},
    {KeyAction::LightAhead, "^light [0-9]+ moved: sphere at "},
    {KeyAction::LightBack, "^light [0-9]+ moved: sphere at "},
    {KeyAction::LightLeft, "^light [0-9]+ moved: sphere at "},
    {KeyAction::LightRight, "^light [0-9]+ moved: sphere at "},
    {KeyAction::LightUp, "^light [0-9]+ moved: sphere at "},
    {KeyAction::LightDown, "^light [0-9]+ moved: sphere at "},
    {KeyAction::GrowLight, "^light [0-9]+ resized: sphere at .*, radius "},
    {KeyAction::ShrinkLight, "^light [0-9]+ resized: sphere at .*, radius "},
    {KeyAction::Undo, "^undone: light [0-9]+ has another size$"},
    {KeyAction::Undo, "^undone: light [0-9]+ has another size$"},
    {KeyAction::Redo, "^redone: light [0-9]+ has another size$"},
    {KeyAction::Frame, "^light [0-9]+ is framed$"},
    {KeyAction::Home, "^the camera is back where it began$"},
    {KeyAction::Help, "^the help is shown$", 2}, // an open help would take the Escape of Quit
    {KeyAction::Help, "^the help is hidden$"},
    {KeyAction::Quit, "^edits of lights are not saved$"},
    {KeyAction::RemoveLight, "^light [0-9]+ removed: "},
    {KeyAction::Orbit, "^the camera orbits the point ahead$", 2},
    {KeyAction::Orbit, "^the camera flies$"},
    {KeyAction::Forward, "^--camera "},
    {KeyAction::Left, "^--camera "},
    {KeyAction::Back, "^--camera "},
    {KeyAction::Right, "^--camera "},
    {KeyAction::Up, "^--camera "},
    {KeyAction::Down, "^--camera "},
    {KeyAction::Darker, "^exposure compensation "},
    {KeyAction::Brighter, "^exposure compensation "},
    {KeyAction::Culling, "^light culling: brute$", 2},
    {KeyAction::Culling, "^light culling: clustered$"},
    {KeyAction::HeatMap, "^heat map: lights-per-pixel$", 5},
    {KeyAction::HeatMap, "^heat map: evaluated$"},
    {KeyAction::HeatMap, "^heat map: none$", 5},
    {KeyAction::Compare, "^two ways of shading are compared$", 2},
    {KeyAction::Compare, "^one way of shading is shown$"},
    {KeyAction::NextSpecular, "^specular highlights: conic$", 10},
    {KeyAction::Panel, "^the panel is shown$", 2},
    {KeyAction::Panel, "^the panel is hidden$"},
    {KeyAction::ListLights, "^pixel 120,120", 1, "mousemove 120 120 "},
    {KeyAction::SaveImage, "^wrote candelabra-[0-9]+[.]png$"},
    {KeyAction::SaveRadiance, "^wrote candelabra-[0-9]+[.]exr$"},
    {KeyAction::SaveScene, "^wrote candelabra-[0-9]+[.]json$"},
    {KeyAction::FullScreen, "^full screen$"},
    {KeyAction::FullScreen, "^a window again$"},
    {KeyAction::MoreLights, "^building rooms with "},
    {KeyAction::FewerLights, "^building rooms with "},
    // While the scene is built with more lights, the present ones cannot be edited.
    {KeyAction::AddLight, "^the scene is built anew", 1, "key bracketright "},
    {KeyAction::Quit, "^the viewer is closed$"}};

// Values of the last lines of a log that begin with `start`.
std::vector<std::string> linesWith(const std::string& log, const std::string& start)
{
    std::vector<std::string> out;
    std::stringstream lines(log.substr(log.find("the checks begin")));
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with(start))
            out.push_back(line);
    return out;
}

TEST(Viewer, EveryKeyWorksAfterRandomInputs)
{
    ASSERT_NO_FATAL_FAILURE(requireTools());
    const std::filesystem::path dir = emptyFolder("candelabra_keys_");
    std::ofstream(dir / "inputs.txt") << randomInputs(17);
    std::ofstream checks(dir / "checks.txt");
    std::set<KeyAction> checked;
    for (const KeyCheck& check : keyChecks) {
        checked.insert(check.action);
        for (const KeyBinding& binding : allBindings())
            if (binding.action == check.action)
                checks << check.tries << '\t' << check.before << pressed(binding) << '\t'
                       << check.expected << '\n';
    }
    checks.close();
    for (const KeyBinding& binding : allBindings())
        EXPECT_TRUE(checked.contains(binding.action)) << pressed(binding) << " is not checked";

    EXPECT_EQ(runSession("viewer_keys.sh", dir), 0)
        << textOf(dir / "err.txt") << textOf(dir / "log.txt");
    const std::string log = textOf(dir / "log.txt");
    ASSERT_NE(log.find("the checks begin"), std::string::npos);
    using candelabra::app::loadScene;
    const glm::dvec3 home = loadScene("rooms", {.lights = 1}).cameras[0].position;
    EXPECT_NE(
        log.find(fmt::format("the camera is back where it began\n--camera {:.4f},{:.4f},{:.4f},",
                             home.x, home.y, home.z),
                 log.find("the checks begin")),
        std::string::npos);
    // The last light of the saved scene is the bulb that N added.
    const std::string saved = linesWith(log, "wrote candelabra-").back().substr(6);
    const CndLight bulb = loadScene((dir / saved).string(), {}).lights.back();
    float lumens[3] = {};
    EXPECT_EQ(cndLuminousPowerOfLight(&bulb, lumens, nullptr), CND_SUCCESS);
    EXPECT_NEAR(lumens[0], 800, 0.1);
    EXPECT_FLOAT_EQ(bulb.radius, 0.03f);
    // The lines say what the viewer holds: each of these keys has changed it.
    for (const char* start : {"--camera ", "exposure compensation "}) {
        const std::vector<std::string> lines = linesWith(log, start);
        ASSERT_GE(lines.size(), 2u) << start;
        for (size_t i = 1; i < lines.size(); ++i)
            EXPECT_NE(lines[i], lines[i - 1]) << log;
    }
    if (!HasFailure())
        std::filesystem::remove_all(dir);
}

// Values of an image, from 0 to 1 in a .png file, and radiance in an .exr file.
std::vector<float> valuesOf(const std::filesystem::path& path)
{
    if (path.extension() == ".exr")
        return candelabra::app::loadImageByExtension(path).pixels;
    int width = 0, height = 0, channels = 0;
    unsigned char* bytes = stbi_load(path.c_str(), &width, &height, &channels, 3);
    if (!bytes)
        return {};
    std::vector<float> out(bytes, bytes + size_t(width) * height * 3);
    stbi_image_free(bytes);
    for (float& value : out)
        value /= 255;
    return out;
}

// Mean of (a - b)^2 / (b^2 + 0.01).
double relativeError(const std::filesystem::path& a, const std::filesystem::path& b)
{
    const std::vector<float> x = valuesOf(a), y = valuesOf(b);
    EXPECT_EQ(x.size(), 200u * 150 * 3) << a;
    EXPECT_EQ(y.size(), x.size()) << b;
    double sum = 0;
    for (size_t i = 0; i < std::min(x.size(), y.size()); ++i)
        sum += double(x[i] - y[i]) * double(x[i] - y[i]) / (double(y[i]) * double(y[i]) + 0.01);
    return sum / double(std::max<size_t>(x.size(), 1));
}

// The numbers of the last match of an expression with groups.
std::vector<int> lastNumbers(const std::string& text, const char* expression)
{
    std::vector<int> out;
    const std::regex pattern(expression);
    for (std::sregex_iterator i(text.begin(), text.end(), pattern), end; i != end; ++i) {
        out.clear();
        for (size_t group = 1; group < i->size(); ++group)
            out.push_back(std::stoi((*i)[group]));
    }
    return out;
}

constexpr const char* completeLine = "picture: complete after ([0-9]+) frames";
constexpr const char* endLine = "picture: ([0-9]+) frames? drawn, and ([0-9]+) for the panel alone";

TEST(Viewer, ShowsThePictureOfRenderAndDrawsNoMore)
{
    ASSERT_NO_FATAL_FAILURE(requireTools());
    const std::filesystem::path dir = emptyFolder("candelabra_still_");
    // The picture has the aspect 4 / 3, so that the frame of the camera does not fill it.
    std::ofstream(dir / "wide.json") << R"({"source": {"scene": "hall"},
        "camera": {"position": [-3, 2, 4], "look_at": [1, 1.5, -6], "up": [0, 1, 0],
                   "vertical_fov_degrees": 35, "aspect": 2},
        "lights": [{"type": "sphere", "position": [0, 3, -1], "radius": 0.1,
                    "luminous_power": [3000, 3000, 3000]}]})";
    ASSERT_EQ(runSession("viewer_still.sh", dir), 0)
        << textOf(dir / "err.txt") << textOf(dir / "session.txt");

    // 16 samples are summed once the statistics of the first frame are there. The rest of the 24
    // frames draw the panel alone.
    const std::string still = textOf(dir / "24.txt");
    EXPECT_EQ(lastNumbers(still, completeLine), (std::vector{18})) << still;
    EXPECT_EQ(lastNumbers(still, endLine), (std::vector{18, 6})) << still;
    const double summed = relativeError(dir / "24.png", dir / "wide.png");
    const double single = relativeError(dir / "2.png", dir / "wide.png");
    std::cout << "error of the summed picture " << summed << ", of a single frame " << single
              << "\n";
    EXPECT_LT(summed, 1e-4);
    EXPECT_GT(single, 10 * summed + 1e-3);
    // Moving lights never stand still.
    const std::string lights = textOf(dir / "lights.txt");
    EXPECT_EQ(lastNumbers(lights, endLine), (std::vector{20, 0})) << lights;
    EXPECT_EQ(lights.find("complete"), std::string::npos);

    // While the camera moves, the picture is half as large; what is saved and picked is not.
    const std::string session = textOf(dir / "session.txt");
    EXPECT_GT(relativeError(dir / "candelabra-001.png", dir / "wide.png"), 1e-3);
    EXPECT_NE(session.find("pixel 100,120 at "), std::string::npos) << session;
    // After the move the picture is that of the camera that was printed, which is not the first
    // one.
    EXPECT_GT(relativeError(dir / "moved.png", dir / "wide.png"), 1e-3);
    EXPECT_LT(relativeError(dir / "candelabra-002.png", dir / "moved.png"), 3e-4);
    EXPECT_LT(relativeError(dir / "candelabra-003.exr", dir / "moved.exr"), 3e-2);
    // Since then, keys and the mouse have changed the panel alone.
    const std::vector<int> complete = lastNumbers(session, completeLine),
                           end = lastNumbers(session, endLine);
    ASSERT_EQ(complete.size(), 1u) << session;
    ASSERT_EQ(end.size(), 2u) << session;
    EXPECT_EQ(end[0], complete[0]) << session;
    EXPECT_GE(end[1], 4) << session;
    if (!HasFailure())
        std::filesystem::remove_all(dir);
}

} // namespace
