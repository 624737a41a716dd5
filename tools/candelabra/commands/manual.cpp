// SPDX-License-Identifier: Apache-2.0
// candelabra help, candelabra manual, candelabra completions: what --help says, also for man and
// for shells.
#include <functional>

#include <fmt/format.h>

#include "candelabra/candelabra.h"
#include "commands/commands.h"
#include "io/choice.h"
#include "io/report.h"

namespace candelabra::app
{
namespace
{

enum class Shell { Bash, Zsh, Fish };
constexpr Choice<Shell> shellChoices[] = {
    {"bash", Shell::Bash}, {"zsh", Shell::Zsh}, {"fish", Shell::Fish}};

std::vector<const CLI::App*> partsOf(const CLI::App& app)
{
    return app.get_subcommands([](const CLI::App*) { return true; });
}

// The options that are typed with dashes.
std::vector<const CLI::Option*> namedOptions(const CLI::App& app)
{
    return app.get_options([](const CLI::Option* o) { return o->nonpositional(); });
}

// "-o,--output" -> "-o", "--output".
std::vector<std::string> spellings(const CLI::Option& option)
{
    std::vector<std::string> out;
    for (const std::string& name : option.get_snames())
        out.push_back("-" + name);
    for (const std::string& name : option.get_lnames())
        out.push_back("--" + name);
    return out;
}

// Calls `use` for the program and every command with the words that lead to it: "", " bench", ...
void forCommands(const CLI::App& app, const std::string& words,
                 const std::function<void(const CLI::App&, const std::string&)>& use)
{
    use(app, words);
    for (const CLI::App* part : partsOf(app))
        forCommands(*part, words + " " + part->get_name(), use);
}

std::string bashCompletions(const CLI::App& root)
{
    std::string known, cases;
    forCommands(root, "", [&](const CLI::App& app, const std::string& words) {
        std::string offered;
        for (const CLI::App* part : partsOf(app)) {
            known += fmt::format("{}\"{} {}\"", known.empty() ? "" : "|", words, part->get_name());
            offered += part->get_name() + " ";
        }
        for (const CLI::Option* option : namedOptions(app))
            for (const std::string& name : spellings(*option))
                offered += name + " ";
        cases += fmt::format("    \"{}\") words=\"{}\" ;;\n", words, offered);
    });
    return fmt::format("# bash: source this, or put it where bash-completion looks\n"
                       "_candelabra() {{\n"
                       "    local cur=${{COMP_WORDS[COMP_CWORD]}} command=\"\" word words\n"
                       "    for word in \"${{COMP_WORDS[@]:1:COMP_CWORD-1}}\"; do\n"
                       "        case \"$command $word\" in\n"
                       "        {}) command=\"$command $word\" ;;\n"
                       "        esac\n"
                       "    done\n"
                       "    case \"$command\" in\n{}    esac\n"
                       "    COMPREPLY=($(compgen -W \"$words\" -- \"$cur\"))\n"
                       "    [[ $cur == -* ]] || COMPREPLY+=($(compgen -f -- \"$cur\"))\n"
                       "}}\n"
                       "complete -o filenames -F _candelabra candelabra\n",
                       known, cases);
}

std::string quotedForFish(const std::string& text)
{
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'' || c == '\\')
            out += '\\';
        out += c;
    }
    return out + "'";
}

std::string fishCompletions(const CLI::App& root)
{
    std::string out = "# fish: put this into ~/.config/fish/completions/candelabra.fish\n";
    forCommands(root, "", [&](const CLI::App& app, const std::string& words) {
        const std::string seen =
            words.empty() ? "__fish_use_subcommand"
                          : "__fish_seen_subcommand_from" + words.substr(words.rfind(' '));
        for (const CLI::App* part : partsOf(app))
            out += fmt::format("complete -c candelabra -n '{}' -a {} -d {}\n", seen,
                               part->get_name(), quotedForFish(part->get_description()));
        for (const CLI::Option* option : namedOptions(app)) {
            std::string names;
            for (const std::string& name : option->get_snames())
                names += " -s " + name;
            for (const std::string& name : option->get_lnames())
                names += " -l " + name;
            out += fmt::format("complete -c candelabra -n '{}'{}{} -d {}\n", seen, names,
                               option->get_expected_min() > 0 ? " -r" : "",
                               quotedForFish(option->get_description()));
        }
    });
    return out;
}

// The manual page is not made by help2man, which reads the text of one --help. Of this program it
// (1.49 was tried) makes one page per command, 16 in all, each under the name of candelabra(1),
// without the exit status, and the examples of a command run together into one paragraph. Here the
// options come from the parser itself, as those of the completions do.

// Text of a manual page: backslashes and dashes are themselves, no line is a request.
std::string roff(const std::string& text)
{
    std::string out;
    bool lineStart = true;
    for (const char c : text) {
        if (lineStart && (c == '.' || c == '\''))
            out += "\\&";
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
        lineStart = c == '\n';
    }
    return out;
}

std::string manualOf(const CLI::App& app)
{
    std::string out;
    for (const CLI::Option* option : app.get_options()) {
        std::string names;
        for (const std::string& name : spellings(*option))
            names += (names.empty() ? "\\fB" : ", \\fB") + roff(name) + "\\fR";
        if (names.empty())
            names = "\\fI" + roff(option->get_name()) + "\\fR";
        else if (option->get_expected_min() > 0)
            names += " \\fI" + roff(option->get_type_name()) + "\\fR";
        const std::string fallback = option->get_default_str();
        out += fmt::format(".TP\n{}\n{}{}\n", names, roff(option->get_description()),
                           fallback.empty() ? "" : " [" + roff(fallback) + "]");
    }
    if (const std::string footer = app.get_footer(); !footer.empty())
        out += ".PP\n.nf\n" + roff(footer) + "\n.fi\n";
    return out;
}

std::string manualPage(const CLI::App& root)
{
    const uint32_t version = cndGetVersion();
    std::string out = fmt::format(
        ".TH CANDELABRA 1 \"\" \"candelabra {}.{}.{}\"\n.SH NAME\ncandelabra \\- {}\n"
        ".SH SYNOPSIS\n\\fBcandelabra\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n.SH OPTIONS\n{}",
        version >> 22, (version >> 12) & 0x3ff, version & 0xfff, roff(root.get_description()),
        manualOf(root));
    out += ".SH COMMANDS\n";
    forCommands(root, "", [&](const CLI::App& app, const std::string& words) {
        if (!words.empty())
            out += fmt::format(".SS \"candelabra{}\"\n{}\n{}", roff(words),
                               roff(app.get_description()), manualOf(app));
    });
    return out +
           ".SH EXIT STATUS\n0: done. 1: something failed that should have worked, or a check "
           "failed. 2: arguments, files or an environment that cannot be worked with. 3: "
           "compare found something slower.\n";
}

} // namespace

void addManualCommands(CLI::App& app, Run& run)
{
    CLI::App* help =
        app.add_subcommand("help", "Print the help of the program or of one of its commands");
    // The program reads "help WORDS" as "WORDS --help", so this command is never run. It is listed
    // with the others.
    help->add_option("command")->description("the command, such as render or bench culling");
    help->footer("Examples:\n"
                 "  candelabra help\n"
                 "  candelabra help bench culling");
    CLI::App* manual = app.add_subcommand("manual", "Print the manual page");
    manual->footer("Examples:\n"
                   "  candelabra manual > candelabra.1 && man ./candelabra.1");
    manual->callback([&run, &app] {
        run = [&app](const ProgramContext&) {
            writeText("-", manualPage(app));
            return exitOk;
        };
    });
    CLI::App* completions =
        app.add_subcommand("completions", "Print what makes a shell complete commands and options");
    const auto shell = std::make_shared<std::string>();
    completions
        ->add_option("shell", *shell,
                     "one of " + names<Shell>(std::span<const Choice<Shell>>(shellChoices)))
        ->required();
    completions->footer("Examples:\n"
                        "  source <(candelabra completions bash)");
    completions->callback([&run, &app, shell] {
        run = [&app, shell](const ProgramContext&) {
            const Shell wanted = choose("shell", *shell, shellChoices);
            const std::string bash = wanted == Shell::Fish ? "" : bashCompletions(app);
            writeText("-", wanted == Shell::Fish ? fishCompletions(app)
                           : wanted == Shell::Zsh
                               ? "autoload -U +X bashcompinit && bashcompinit\n" + bash
                               : bash);
            return exitOk;
        };
    });
}

} // namespace candelabra::app
