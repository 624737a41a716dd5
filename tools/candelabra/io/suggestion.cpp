// SPDX-License-Identifier: Apache-2.0
#include "io/suggestion.h"

#include <algorithm>
#include <cctype>

namespace candelabra::app
{
namespace
{

std::string comparableForm(const std::string& word)
{
    std::string out = word.substr(std::min(word.find_first_not_of('-'), word.size()));
    for (char& c : out)
        c = char(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

// The number of edits that lead from one word to the other (optimal string alignment).
size_t edits(const std::string& a, const std::string& b)
{
    // Row i holds the edits from the first i letters of a to the first j letters of b.
    std::vector<std::vector<size_t>> rows(a.size() + 1, std::vector<size_t>(b.size() + 1));
    for (size_t i = 0; i <= a.size(); ++i) {
        for (size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                rows[i][j] = i + j;
                continue;
            }
            const size_t replaced = rows[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
            rows[i][j] = std::min({replaced, rows[i - 1][j] + 1, rows[i][j - 1] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                rows[i][j] = std::min(rows[i][j], rows[i - 2][j - 2] + 1);
        }
    }
    return rows.back().back();
}

} // namespace

std::string closestWord(const std::string& word, const std::vector<std::string>& known)
{
    constexpr size_t longest = 64; // no option or command is as long, and a typed text may be
    const std::string wanted = comparableForm(word);
    if (wanted.size() > longest)
        return "";
    size_t fewest = wanted.size() / 3 + 1, beginnings = 0;
    std::string best, begun;
    for (const std::string& candidate : known) {
        const size_t count = edits(wanted, comparableForm(candidate));
        if (count < fewest) {
            fewest = count;
            best = candidate;
        }
        if (wanted.size() > 1 && comparableForm(candidate).starts_with(wanted)) {
            begun = candidate;
            ++beginnings;
        }
    }
    return best.empty() && beginnings == 1 ? begun : best;
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& known)
{
    const std::string closest = closestWord(word, known);
    return closest.empty() ? "" : "; did you mean " + closest + "?";
}

} // namespace candelabra::app
