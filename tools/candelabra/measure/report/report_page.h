// SPDX-License-Identifier: Apache-2.0
// Puts the page of `candelabra report` together from sentences, pictures and tables. The same
// content gives the same page.
#pragma once

#include <string>
#include <vector>

#include "io/table.h"

namespace candelabra::app
{

struct ReportSection {
    std::string id, title; // `id` is unique on the page
    std::string intro;     // a few sentences: what is measured, and how to read it
    std::string html;      // pictures and plots, which come before the tables
    std::vector<Table> tables;
    std::string command;             // with which the section can be made again; may be empty
    std::vector<Table> details = {}; // long tables, which are shown on a click
};

struct ReportPage {
    std::string title;
    std::string about; // a paragraph for somebody who does not know the project
    std::vector<std::string> sentences;
    std::vector<std::string> notes; // below the sentences
    std::vector<ReportSection> sections;

    // Marks the rows of all tables that contradict committed results.
    void markContradictions(const std::vector<std::string>& keys);
};

// The whole HTML page: the sentences, the contents, the sections, and links to the explanations of
// terms. Every term of the glossary is explained once, where the page uses it first.
std::string htmlOf(const ReportPage& page);

} // namespace candelabra::app
