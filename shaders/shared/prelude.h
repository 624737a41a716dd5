// SPDX-License-Identifier: Apache-2.0
// Makes the headers of this folder compile as C++ and as GLSL (with scalar block layout). The only
// file that knows which of the two is reading it. Data crosses this border, formulas never do.
// The C++ half has a file of its own: hosts' shaders get this one alone, and it names no library.
#ifndef CND_SHARED_PRELUDE_H
#define CND_SHARED_PRELUDE_H

#ifdef __cplusplus
#include "shared/prelude_cpp.h"
#else
#extension GL_EXT_scalar_block_layout : require
#define GPU_BEGIN
#define GPU_END
#define GPU_SIZE(Type, bytes)
#endif

#endif
