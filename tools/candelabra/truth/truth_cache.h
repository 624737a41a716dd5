// SPDX-License-Identifier: Apache-2.0
// Stores computed truths in a directory, so that the same truth is not computed twice.
#pragma once

#include <optional>
#include <string>

#include "truth/truth_file.h"

namespace candelabra::app
{

class TruthCache
{
public:
    // Returns the cache in $XDG_CACHE_HOME/candelabra/truth or in $HOME/.cache/candelabra/truth. If
    // neither variable holds an absolute path, the cache stores nothing.
    static TruthCache standard();
    // The cache in `directory`, which is created when something is stored.
    explicit TruthCache(const std::string& directory) : directory_(directory) {}
    // A cache that stores nothing and finds nothing.
    TruthCache() = default;

    const std::string& directory() const { return directory_; } // empty: it stores nothing
    // Looks for the shard that the other members of `wanted` describe. Returns true and sets its
    // pixels if the cache has it. A file that does not hold what its name says is ignored.
    bool find(TruthShard& wanted) const;
    // Stores the shard. If that fails, a warning is logged, and the program continues.
    void store(const TruthShard& shard) const;

private:
    std::string file(const TruthShard& shard) const;

    std::string directory_;
};

} // namespace candelabra::app
