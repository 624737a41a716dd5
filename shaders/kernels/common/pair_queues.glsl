// SPDX-License-Identifier: Apache-2.0
// Queues of pairs of pixel and light, which the lanes of a group fill and evaluate together. Spheres
// near the horizon of a pixel, and spheres that the horizon cuts, take two to four times as long to
// evaluate as others, and most pixels have none or one. If each lane evaluated those of its own pixel,
// most lanes would wait for a few. The same happens to all spheres where lists are long and each pixel
// is reached by other lights than its neighbours. Each pixel adds up the responses of its own pairs in
// the order of the lights, so the sums do not depend on which lane evaluated a pair, or when.
#ifndef CND_COMMON_PAIR_QUEUES
#define CND_COMMON_PAIR_QUEUES

#include "shading/light_walk.glsl"

const uint QUEUE_LANES = TILE_SIZE * TILE_SIZE;
const uint QUEUE_ROOM = 128u; // pairs in one queue
// The queues, by the function that evaluates their pairs.
const uint QUEUE_NEAR = 0u;   // evaluateNear
const uint QUEUE_ACROSS = 1u; // evaluateGeneral
const uint QUEUE_ABOVE = 2u;  // evaluateAbove
const uint QUEUES = 3u;
// A pair holds the lane of its pixel in this many bits, and above them the index of its light, which
// has at most 26 bits (engine/lights/light_limits.cpp).
const uint PAIR_LANE_BITS = 6u;

shared uint wanted[QUEUES]; // pairs that the lanes wanted to append; those beyond QUEUE_ROOM wait
shared uint lastUnqueued;   // the last step in which some lane found no room for all of its pairs
shared uint lastUnfinished; // the last step in which some lane had more blocks to take
shared uint aboveTotal;     // number of lights above the horizon that all lanes have found in a step
shared uint aboveLargest;   // the largest such number of one lane
// A pair and then, when it is evaluated, the bits of the response in its place. Pipelines whose lanes
// work alone ask for no shared memory.
shared uvec3 slots[lanesTogether ? QUEUES * QUEUE_ROOM : 1u];
// Sums of the responses of each lane's own pairs. They are here to leave registers to the evaluations.
shared vec3 nearLight[lanesTogether ? QUEUE_LANES : 1u];
shared vec3 acrossLight[lanesTogether ? QUEUE_LANES : 1u];

void emptyQueues()
{
    if (gl_LocalInvocationIndex == 0u) {
        for (uint q = 0u; q < QUEUES; ++q)
            wanted[q] = 0u;
        aboveTotal = 0u;
        aboveLargest = 0u;
    }
}

void beginQueues()
{
    emptyQueues();
    if (gl_LocalInvocationIndex == 0u)
        lastUnqueued = lastUnfinished = 0u;
    nearLight[gl_LocalInvocationIndex] = vec3(0.0);
    acrossLight[gl_LocalInvocationIndex] = vec3(0.0);
    barrier();
}

uint countOf(uvec2 lights)
{
    return uint(bitCount(lights.x) + bitCount(lights.y));
}

// Tells whether queueing the lights above the horizon that the lanes have found is faster than
// evaluating them in place, where the group takes as long as the lane with the most. A queued pair
// takes about twice as long, because its surface is read again. All lanes call it together.
bool queueingAboveIsFaster(uvec2 above)
{
    const uint count = countOf(above);
    if (count != 0u) {
        atomicAdd(aboveTotal, count);
        atomicMax(aboveLargest, count);
    }
    barrier();
    return 2u * aboveTotal < QUEUE_LANES * aboveLargest;
}

// The lights of a block that a lane has yet to append to a queue: first + (bits that are set).
struct Unqueued {
    uint first;
    uvec2 inQueue[QUEUES];
};

Unqueued nothingToQueue()
{
    return Unqueued(0u, uvec2[QUEUES](uvec2(0u), uvec2(0u), uvec2(0u)));
}

bool isEmpty(Unqueued left)
{
    return none(left.inQueue[QUEUE_NEAR] | left.inQueue[QUEUE_ACROSS] | left.inQueue[QUEUE_ABOVE]);
}

// The pairs that a lane has appended to each queue in one step: from the index `first` to before `end`,
// which are kept in 8 bits each.
struct OwnPairs {
    uint firsts, ends;
};

// Appends as many lights of this lane to the queues as there is room for. All lanes meet in endOfStep
// before they call it again.
OwnPairs queuePairs(inout Unqueued left)
{
    OwnPairs own = OwnPairs(0u, 0u);
    for (uint q = 0u; q < QUEUES; ++q) {
        const uint count = countOf(left.inQueue[q]);
        if (count == 0u)
            continue;
        const uint first = atomicAdd(wanted[q], count);
        const uint end = min(first + count, QUEUE_ROOM);
        if (first < end) {
            own.firsts |= first << 8u * q;
            own.ends |= end << 8u * q;
        }
        for (uint at = first; at < end; ++at) {
            const uint light = lightAt(left.first + lowest(left.inQueue[q]));
            slots[QUEUE_ROOM * q + at].x = light << PAIR_LANE_BITS | gl_LocalInvocationIndex;
            left.inQueue[q] = withoutLowest(left.inQueue[q]);
        }
    }
    return own;
}

// Waits until all lanes have appended their pairs. `step` grows from call to call, and begins with 1.
void endOfStep(uint step, bool unqueued, bool unfinished)
{
    if (unqueued)
        atomicMax(lastUnqueued, step);
    if (unfinished)
        atomicMax(lastUnfinished, step);
    barrier();
}

// Returns how many pairs of a queue this lane evaluates.
uint turnsInQueue(uint queue)
{
    const uint length = min(wanted[queue], QUEUE_ROOM);
    return (length + QUEUE_LANES - 1u - gl_LocalInvocationIndex) / QUEUE_LANES;
}

// Evaluates the pairs of a queue. The includer provides Receiver receiverInTile(uint tile, uint lane).
#define EVALUATE_QUEUE(queue, tile, evaluate)                                                      \
    {                                                                                              \
        const uint first = QUEUE_ROOM * (queue);                                                   \
        const uint end = first + min(wanted[queue], QUEUE_ROOM);                                   \
        for (uint at = first + gl_LocalInvocationIndex; at < end; at += QUEUE_LANES) {             \
            const uint pair = slots[at].x;                                                         \
            const uint lane = bitfieldExtract(pair, 0, int(PAIR_LANE_BITS));                       \
            slots[at] =                                                                            \
                floatBitsToUint(evaluate(receiverInTile(tile, lane), pair >> PAIR_LANE_BITS));     \
        }                                                                                          \
    }

// Adds the responses of this lane's own pairs in a queue to a sum.
void addResponses(inout vec3 sum, uint queue, OwnPairs own)
{
    const int shift = int(8u * queue);
    const uint end = bitfieldExtract(own.ends, shift, 8);
    for (uint at = bitfieldExtract(own.firsts, shift, 8); at < end; ++at)
        sum += uintBitsToFloat(slots[QUEUE_ROOM * queue + at]);
}

#endif
