// SPDX-License-Identifier: Apache-2.0
// MovingSize decides whether the viewer draws at half width and height: on slow devices while the
// user moves. PieceRows decides how many rows of a picture it draws at a time. Neither needs a
// window.
#pragma once

#include <cstdint>

#include "io/choice.h"
#include "io/parse.h"

namespace candelabra::app
{

// The size in which frames are drawn while the camera moves or a drag edits a light.
enum class WhileMoving {
    Auto, // half if frames at full size take longer than MovingSize::slowFrame
    Full,
    Half
};
inline constexpr Choice<WhileMoving> whileMovingChoices[] = {
    {"auto", WhileMoving::Auto}, {"full", WhileMoving::Full}, {"half", WhileMoving::Half}};

// The size with half the width and height, rounded up.
constexpr PixelSize halfOf(PixelSize size)
{
    return {(size.width + 1) / 2, (size.height + 1) / 2};
}

class MovingSize
{
public:
    static constexpr double slowFrame = 1.0 / 15; // s
    // A device is no longer slow when frames take less than this share of it, so that frames which
    // take about so long are not drawn in different sizes in turns.
    static constexpr double quickShare = 0.75;
    // The full size comes back when nothing has moved for so long, and for so many frames.
    static constexpr double stillTime = 0.2; // s
    static constexpr uint32_t stillFrames = 2;

    // Call it before each frame. `seconds`: the time since the last call.
    void advance(double seconds, bool moves, WhileMoving choice);
    // Call it after each frame. `lit`: the frame was drawn at full size, and did not reuse the lit
    // image of the frame before, which would tell nothing about frames that move.
    void drew(bool lit);

    bool isHalf() const { return half_; }
    bool isSlow() const { return slow_; } // frames at full size take longer than slowFrame

private:
    uint32_t litFrames_ = 0; // how many frames in a row were lit
    uint32_t slower_ = 0, quicker_ = 0;
    bool slow_ = false;
    bool half_ = false;
    double stillSeconds_ = stillTime;
    uint32_t stillFrames_ = stillFrames;
};

// Chooses how many rows of a picture each piece has, so that a piece takes about `pieceTime`, and
// input is answered between two pieces.
class PieceRows
{
public:
    static constexpr double pieceTime = 0.05; // s

    // Returns the end of the piece that begins with row `first` of a picture.
    uint32_t endOf(uint32_t first, uint32_t height);
    // Call it when the piece has been drawn. Pieces become shorter at once. They become longer only
    // after a whole picture, and only as far as its slowest rows allow.
    void took(double seconds);

private:
    uint32_t rows_ = 64, drawn_ = 0;
    bool whole_ = false;  // the last piece ended a picture
    double slowest_ = 64; // rows that take pieceTime where the picture takes longest
};

} // namespace candelabra::app
