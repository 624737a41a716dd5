// SPDX-License-Identifier: Apache-2.0
// Makes the headers of this folder compile as C++ and as GLSL (with scalar block layout). It is the
// only file that distinguishes the two. The headers hold data, never formulas. The C++ half is a
// file of its own, because hosts' shaders get only this file, which must not depend on a C++
// library.
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
