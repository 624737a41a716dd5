// SPDX-License-Identifier: Apache-2.0
// A fuzzing driver for g++, which has no libFuzzer: runs the seeds, then mutations of them, always
// the same sequence.
//   fuzz_X [EXECUTIONS] [FILE...]        each FILE is run unchanged
#include <algorithm>
#include <random>

#include "fuzz/fuzz_target.h"

namespace
{

using candelabra::test::Seeds;

constexpr const char* interesting[] = {"-1",      "0",    "4294967295", "4294967296", "1e999",
                                       "-1e-320", "nan",  "null",       "{}",         "[]",
                                       "\"\"",    "true", "\xff",       "\xc3\x28",   "\n",
                                       "[[[[",    "1e38", "-0",         " ",          "\\u0000"};
constexpr size_t longestInput = 1 << 16;

class Mutator
{
public:
    explicit Mutator(const Seeds& seeds) : seeds_(seeds) {}

    std::string next()
    {
        std::string out = seeds_[pick(seeds_.size())];
        for (size_t n = 1 + pick(4); n; --n)
            mutate(out);
        out.resize(std::min(out.size(), longestInput));
        return out;
    }

private:
    // Returns a number in 0 .. below - 1; 0 if `below` is 0.
    size_t pick(size_t below) { return below ? random_() % below : 0; }

    void mutate(std::string& s)
    {
        const size_t at = pick(s.size() + 1), count = std::min(pick(16) + 1, s.size() - at);
        switch (pick(7)) {
        case 0:
            if (at < s.size())
                s[at] = char(random_());
            break;
        case 1:
            if (at < s.size())
                s[at] = char(s[at] ^ (1 << pick(8)));
            break;
        case 2:
            s.erase(at, count);
            break;
        case 3:
            s.insert(at, interesting[pick(std::size(interesting))]);
            break;
        case 4:
            s.replace(at, count, interesting[pick(std::size(interesting))]);
            break;
        case 5: { // bytes from elsewhere, also from another seed
            const std::string& from = seeds_[pick(seeds_.size())];
            const size_t first = pick(from.size());
            s.insert(at, from, first, pick(64));
            break;
        }
        default:
            s.resize(at);
        }
    }

    const Seeds& seeds_;
    std::mt19937_64 random_{1};
};

void run(const std::string& input)
{
    LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(input.data()), input.size());
}

} // namespace

int main(int argc, char** argv)
{
    const Seeds seeds = candelabra::test::fuzzSeeds();
    const unsigned long executions = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1000;
    for (int i = 2; i < argc; ++i)
        run(candelabra::test::fileText(argv[i]));
    for (const std::string& seed : seeds)
        run(seed);
    Mutator mutator(seeds);
    for (unsigned long i = 0; i < executions; ++i)
        run(mutator.next());
    std::cout << executions << " mutations of " << seeds.size() << " seeds\n";
}
