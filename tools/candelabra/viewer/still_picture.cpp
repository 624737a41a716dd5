// SPDX-License-Identifier: Apache-2.0
#include "viewer/still_picture.h"

#include <cmath>

namespace candelabra::app
{

bool isSummed(const FrameOptions& frame)
{
    return frame.heatMap == HeatMap::None && frame.influence.rule != CND_INFLUENCE_BY_ERROR;
}

void StillPicture::show(const PictureSettings& settings)
{
    if (settings_ == settings)
        return;
    settings_ = settings;
    change();
}

void StillPicture::change()
{
    ++version_;
    drawnSince_ = adapted_ = false;
    summed_ = 0;
}

void StillPicture::measured(uint32_t slot, float evLeft)
{
    // The samples of a sum have the exposure of the first one, however long they take.
    if (isCurrent(slot) && !summed_)
        adapted_ = std::abs(evLeft) <= mostEvLeft;
}

std::optional<FrameSample> StillPicture::next() const
{
    if (!adapted_ || !settings_)
        return FrameSample{};
    const bool sums =
        isSummed(settings_->left) || (settings_->right && isSummed(*settings_->right));
    if (!sums || summed_ == pictureSamples)
        return std::nullopt;
    return FrameSample{summed_, pictureSamples};
}

void StillPicture::drawn(uint32_t slot)
{
    if (const auto sample = next(); sample && sample->count > 1)
        ++summed_;
    drawnSince_ = true;
    drawnIn_[slot] = version_;
}

} // namespace candelabra::app
