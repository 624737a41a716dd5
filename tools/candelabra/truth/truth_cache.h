// SPDX-License-Identifier: Apache-2.0
// Where computed truths are kept, so that the same one is never computed twice.
#pragma once

#include <optional>
#include <string>

#include "truth/truth_file.h"

namespace candelabra::app
{

class TruthCache
{
public:
    // $XDG_CACHE_HOME/candelabra/truth or ~/.cache/candelabra/truth; no cache where neither
    // variable says something.
    static TruthCache standard();
    // This directory, which is made when something is stored.
    explicit TruthCache(const std::string& directory) : directory_(directory) {}
    // No cache: finds nothing and stores nothing.
    TruthCache() = default;

    // Fills in the pixels of a shard whose other members say what is wanted. Files that are not
    // what their name says are as good as absent.
    bool find(TruthShard& wanted) const;
    // A cache that cannot be written is a warning, not an error.
    void store(const TruthShard& shard) const;

private:
    std::string file(const TruthShard& shard) const;

    std::string directory_;
};

} // namespace candelabra::app
