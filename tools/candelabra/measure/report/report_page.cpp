// SPDX-License-Identifier: Apache-2.0
#include "measure/report/report_page.h"

#include <cctype>

#include <fmt/format.h>

#include "io/html_page.h"
#include "io/markup.h"
#include "measure/report/glossary.h"

namespace candelabra::app
{
namespace
{

std::string paragraph(const std::string& text)
{
    return text.empty() ? "" : "<p>" + escaped(text) + "</p>\n";
}

std::string anchorOf(const Term& term)
{
    std::string out = "term-";
    for (const char c : term.name)
        out += std::isalnum(static_cast<unsigned char>(c)) ? c : '-';
    return out;
}

// Explains the terms that a text uses first.
std::string firstTerms(TermFinder& finder, const std::string& text)
{
    const std::vector<Term> firstHere = finder.firstIn(text);
    if (firstHere.empty())
        return "";
    std::string out = "<div class=\"terms\"><p>Terms that appear here first</p><dl>\n";
    for (const Term& term : firstHere)
        out += fmt::format("<dt id=\"{}\">{}</dt><dd>{}</dd>\n", anchorOf(term), escaped(term.name),
                           escaped(term.meaning));
    return out + "</dl></div>\n";
}

// All words of a section that a reader sees, without those of plots and pictures.
std::string wordsOf(const ReportSection& section)
{
    std::string out = section.title + "\n" + section.intro + "\n";
    for (const auto* tables : {&section.tables, &section.details})
        for (const Table& table : *tables) {
            out += table.text() + "\n";
            for (const Column& column : table.columns())
                out += column.about + "\n";
        }
    return out;
}

std::string contents(const std::vector<ReportSection>& sections)
{
    std::string out = "<nav aria-label=\"contents\"><h2>Contents</h2><ul>\n";
    for (const ReportSection& section : sections)
        out += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", escaped(section.id),
                           escaped(section.title));
    return out + "<li><a href=\"#glossary\">Where each term is explained</a></li></ul></nav>\n";
}

std::string htmlOf(const ReportSection& section, TermFinder& finder)
{
    std::string out =
        fmt::format("<h2 id=\"{}\">{}</h2>\n", escaped(section.id), escaped(section.title)) +
        paragraph(section.intro) + firstTerms(finder, wordsOf(section)) + section.html;
    for (const Table& table : section.tables)
        out += table.html();
    for (const Table& table : section.details)
        out += folded("Table: " + table.title(), table.html());
    return out + (section.command.empty() ? "" : madeBy(section.command));
}

// Returns an index of the terms of the page, with links to their explanations.
std::string termIndex(const TermFinder& finder)
{
    std::string out = "<h2 id=\"glossary\">Where each term is explained</h2>\n<p>";
    const char* gap = "";
    for (const Term& term : finder.all()) {
        out += fmt::format("{}<a href=\"#{}\">{}</a>", gap, anchorOf(term), escaped(term.name));
        gap = ", ";
    }
    return out + "</p>\n";
}

} // namespace

void ReportPage::markContradictions(const std::vector<std::string>& keys)
{
    for (ReportSection& section : sections)
        for (auto* tables : {&section.tables, &section.details})
            for (Table& table : *tables)
                table.markContradictions(keys);
}

std::string htmlOf(const ReportPage& page)
{
    TermFinder finder;
    std::string out = pageHead(page.title) + paragraph(page.about) +
                      "<h2>The result in five sentences</h2>\n<ol class=\"sentences\">\n";
    std::string words = page.about + "\n";
    for (const std::string& sentence : page.sentences) {
        out += "<li>" + escaped(sentence) + "</li>\n";
        words += sentence + "\n";
    }
    out += "</ol>\n" + firstTerms(finder, words);
    for (const std::string& note : page.notes)
        out += "<p class=\"note\">" + escaped(note) + "</p>\n";
    out += contents(page.sections);
    for (const ReportSection& section : page.sections)
        out += htmlOf(section, finder);
    return out + termIndex(finder) + pageEnd();
}

} // namespace candelabra::app
