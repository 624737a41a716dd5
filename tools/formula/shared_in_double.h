// SPDX-License-Identifier: Apache-2.0
// A class whose body is made of shaders holds the headers of shaders/shared a second time, in
// double precision. Its source file includes this one last: the namespaces and checks of sizes,
// which these headers have once, must not be in the class.
#pragma once

#undef GPU_BEGIN
#undef GPU_END
#undef GPU_SIZE
#define GPU_BEGIN
#define GPU_END
#define GPU_SIZE(Type, bytes)
