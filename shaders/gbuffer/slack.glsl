// SPDX-License-Identifier: Apache-2.0
#ifndef CND_GBUFFER_SLACK
#define CND_GBUFFER_SLACK

// Largest error of a sum of rounded products, relative to the magnitudes in it: 8 roundings of 2^-24,
// times a safety factor of 20.
const float SLACK = 1e-5;

#endif
