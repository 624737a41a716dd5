// SPDX-License-Identifier: Apache-2.0
// Everything that crosses between the default raster pass (engine/gbuffer) and its shaders.
#ifndef CND_SHARED_RASTER_H
#define CND_SHARED_RASTER_H

#include "shared/gbuffer_data.h"
#include "shared/light_type_list.h"

GPU_BEGIN

// --- Records in texel buffers (vec4), which every vertex or pixel reads

// One instance: the columns of its world-from-object matrix. The translation is hi + lo, a double
// as the sum of two floats.
struct InstanceRecord {
    vec3 axisX;
    float positionHiX;
    vec3 axisY;
    float positionHiY;
    vec3 axisZ;
    float positionHiZ;
    vec3 positionLo;
    float material; // index of the material, exact up to 2^24
};
GPU_SIZE(InstanceRecord, 64)
const uint INSTANCE_TEXELS = 4u;

const uint TEXTURE_BASE_COLOR = 0u;
const uint TEXTURE_METALLIC_ROUGHNESS = 1u;
const uint TEXTURE_NORMAL = 2u;
const uint TEXTURE_EMISSIVE = 3u;
const uint TEXTURES_PER_MATERIAL = 4u;

// One material, in the units of geometry.h. A material without textures needs only the first
// MATERIAL_PLAIN_TEXELS texels.
struct MaterialRecord {
    vec3 baseColor;
    float alpha;
    float metalness;
    float perceptualRoughness;
    float normalScale; // 0 without a normal texture
    float alphaCutoff;
    vec3 dielectricF0;
    float diffuseWeight;
    vec3 emission; // cd/m^2
    float specularWeight;
    vec4 uvRows[8]; // per texture: (uRow, uv set), (vRow, 0)
};
GPU_SIZE(MaterialRecord, 192)
const uint MATERIAL_TEXELS = 12u;
const uint MATERIAL_PLAIN_TEXELS = 4u;

// --- Culling

const uint CHUNK_SIZE = 64u; // instances per chunk; all of them belong to one batch
const uint MESH_LEVELS = 5u; // most levels of detail of a mesh; level 0 is the mesh itself

struct InstanceBounds {
    vec3 centerHi; // world space; the centre is hi + lo
    vec3 centerLo;
    vec3 extent; // half size along the world axes, m
    float scale; // no length of object space is longer than this in world space, m
};
GPU_SIZE(InstanceBounds, 40)

struct Chunk {
    uint firstInstance;
    uint count;
    uint firstChunk;   // first chunk of the batch
    uint lastChunk;    // last chunk of the batch
    uint firstCommand; // of level 0 of the batch's mesh; those of its other levels follow
    uint levelCount;   // 1..MESH_LEVELS
    // Errors of levels 1, 2, ... in object space, above 0 and in ascending order.
    float levelErrors[MESH_LEVELS - 1u];
};
GPU_SIZE(Chunk, 40)

// The same members as VkDrawIndexedIndirectCommand.
struct DrawCommand {
    uint indexCount;
    uint instanceCount;
    uint firstIndex;
    uint vertexOffset;
    uint firstInstance;
};
GPU_SIZE(DrawCommand, 20)

// cull_instances: tests the bounds of each instance and chooses its level, one lane per chunk
const uint CULL_INSTANCES_GROUP = 64u;
const uint CULL_INSTANCES_CHUNKS = 0u;
const uint CULL_INSTANCES_BOUNDS = 1u;
const uint CULL_INSTANCES_BITS = 2u;   // uvec2 per chunk and level: bit i = instance i is drawn so
const uint CULL_INSTANCES_COUNTS = 3u; // uint per chunk and level
const uint CULL_INSTANCES_FRAME = 4u;
struct CullInstancesFrame {
    vec4 planes[6]; // unit normals in world space; p is inside if dot(xyz, p - camera) + w >= 0
    vec3 cameraHi;  // world space; the position is hi + lo
    vec3 cameraLo;
    vec3 eye;          // perspective: where all rays meet, relative to the camera
    vec3 forward;      // unit viewing direction, world space
    float perspective; // 1, or 0: orthographic
    // Pixels that a length of 1 m across the viewing direction has at most; perspective: 1 m ahead.
    float pixelScale;
    float maxLevelError; // pixels; 0: level 0 everywhere
    uint chunkCount;
};
GPU_SIZE(CullInstancesFrame, 160)

// compact_instances: writes the ids of the drawn instances in their old order, one lane per chunk
// and level
const uint COMPACT_INSTANCES_GROUP = 64u;
const uint COMPACT_INSTANCES_CHUNKS = 0u;
const uint COMPACT_INSTANCES_BITS = 1u;
const uint COMPACT_INSTANCES_COUNTS = 2u;
const uint COMPACT_INSTANCES_VISIBLE = 3u;  // uint; each command has a range of its own
const uint COMPACT_INSTANCES_COMMANDS = 4u; // DrawCommand per batch and level
struct CompactInstancesParams {
    uint chunkCount;
};
GPU_SIZE(CompactInstancesParams, 4)

// cull_triangles: leaves out triangles that cover no sample. A piece is up to PIECE_TRIANGLES
// consecutive triangles of one drawn instance. One lane tests a piece, and writes the indices of
// the triangles that remain and a draw command for them.
const uint CULL_TRIANGLES_GROUP = 8u;
const uint PIECE_TRIANGLES = 128u;
const uint CULL_TRIANGLES_FRAME = 0u;
const uint CULL_TRIANGLES_INSTANCES = 1u;     // texels: InstanceRecord
const uint CULL_TRIANGLES_CORNERS = 2u;       // texels: TriangleCorner, three per triangle
const uint CULL_TRIANGLES_BATCHES = 3u;       // PieceBatch
const uint CULL_TRIANGLES_PIECE_BATCHES = 4u; // uint per piece: the PieceBatch that it belongs to
const uint CULL_TRIANGLES_VISIBLE = 5u;       // as compact_instances writes them
const uint CULL_TRIANGLES_COMMANDS = 6u;
const uint CULL_TRIANGLES_KEPT = 7u;  // uint: indices of the triangles that remain
const uint CULL_TRIANGLES_DRAWS = 8u; // DrawCommand per piece
struct CullTrianglesFrame {
    mat3 viewFromWorld; // rotation
    mat4 clipFromView;
    vec3 cameraHi; // world space; the position is hi + lo
    vec3 cameraLo;
    vec2 size;     // of the image, pixels
    float snap;    // pixels by which the rasteriser may move a vertex
    float winding; // 1, or -1: the image is mirrored
    uint pieceCount;
};
GPU_SIZE(CullTrianglesFrame, 144)

// A corner of a triangle of a mesh.
struct TriangleCorner {
    vec3 position; // object space, m
    float vertex;  // its index in the mesh, exact up to 2^24
};
GPU_SIZE(TriangleCorner, 16)

// A batch of instances whose triangles are tested. Its pieces are numbered level by level, and
// within a level instance by instance. There are as many as its instances need at level 0. Coarser
// levels need fewer, so the last pieces may have no triangles in a frame.
struct PieceBatch {
    uint firstPiece;
    uint firstCommand; // of level 0 of the batch's mesh; those of its other levels follow
    uint levelCount;   // 1..MESH_LEVELS
    uint firstKept;    // where its indices begin in CULL_TRIANGLES_KEPT
    uint firstCorner;  // of the mesh, in CULL_TRIANGLES_CORNERS
    uint firstIndex;   // of the mesh, in the index buffer
    float reach;       // no sum of |coordinates| of a vertex is larger in object space, m
    float scale;       // no length of object space is longer than this in world space, m
    float front; // sign of the area of triangles that face the camera, in an image that is not
                 // mirrored, with y down; 0: both sides are drawn
};
GPU_SIZE(PieceBatch, 36)

// --- Meshes

const uint MESH_POSITION = 0u; // vertex attribute locations
const uint MESH_NORMAL_IN = 1u;
const uint MESH_TANGENT = 2u;
const uint MESH_UV = 3u;
const uint MESH_COLOR = 4u;
const uint MESH_INSTANCE = 5u;

const uint MESH_INSTANCES = 0u; // bindings
const uint MESH_MATERIALS = 1u;
const uint MESH_TEXTURES = 2u; // 2, 3, 4, 5: TEXTURE_*

struct MeshParams {
    mat3 viewFromWorld; // rotation
    mat4 clipFromView;
    vec3 cameraHi; // world space; the position is hi + lo
    vec3 cameraLo;
    uint coverageFrame; // number of the frame among those that are averaged
};
GPU_SIZE(MeshParams, 128) // as much as every device takes

// The fragments of a mesh that are drawn: all, those of a coverage above a cutoff, or a share of
// them.
const uint COVERAGE_FULL = 0u;
const uint COVERAGE_MASKED = 1u;
const uint COVERAGE_DITHERED = 2u;

// --- Background, where there is no surface

struct BackgroundParams {
    vec3 luminance; // cd/m^2
};
GPU_SIZE(BackgroundParams, 12)

// --- Ray-cast surfaces: analytic planes and balls, visible area lights

struct RasterFrame {
    mat4 clipFromView;
    mat3 viewFromWorld; // rotation
    vec3 emitterOrigin; // origin of the light set in view space, subtracted in double
    vec3 rayOrigin[3];  // view space: [0] + x [1] + y [2] with x, y in ndc; perspective: [0] is the
                        // eye
    vec3 rayDirection[3]; // likewise; towards the scene, not normalised
    vec2 size;            // pixels
    vec2 inverseSize;     // 1 / size
    float perspective;    // 1, or 0: orthographic
    float nearDepth;      // depth of the near plane: 1 reversed, else 0
    vec3 forward;         // unit viewing direction; orthographic: direction of every ray
};
GPU_SIZE(RasterFrame, 220)
const uint RAY_FRAME = 0u; // uniform buffer binding of analytic surfaces, emitters and background

const uint ANALYTIC_PLANE = 0u;
const uint ANALYTIC_BALL = 1u;

struct AnalyticParams {
    vec3 normalOrCenter; // plane: unit normal; ball: centre. View space, relative to the camera
    float radius;        // ball
    vec3 height;         // plane: height of the ray origin, affine in ndc, computed in double
    vec3 slope;          // plane: dot(normal, ray direction), affine in ndc, computed in double
    float power;         // ball: |centre - rayOrigin[0]|^2 - radius^2, computed in double
    vec3 baseColor;      // factors of the material
    float metalness;
    float perceptualRoughness;
    vec3 dielectricF0;
    float diffuseWeight;
    float specularWeight;
    vec3 emission; // cd/m^2
};
GPU_SIZE(AnalyticParams, 96)

const uint EMITTER_POSITION = 0u; // vertex attribute locations
const uint EMITTER_LUMINANCE = 1u;
const uint EMITTER_AXIS_U = 2u;
const uint EMITTER_AXIS_V = 3u;
const uint EMITTER_CORNERS = 4u; // and the EMITTER_CORNER_PAIRS - 1 locations after it
const uint EMITTER_CORNER_PAIRS = MAX_CORNERS / 2u;
// A visible area light; axes and directions are in world space.
struct EmitterRecord {
    vec3 position;  // centre, relative to the light set's origin, m; distant sphere: unit vector to
                    // it
    float radius;   // m; distant sphere: sine of the angular radius
    vec3 luminance; // cd/m^2
    vec3 axisU;     // tube: half of its segment, m; rectangle: half a side, m; disc: unit normal;
                    // polygon: axis of its corners, m
    vec3 axisV;     // rectangle: half the other side, m; polygon: the other axis, m
    float twoSided; // rectangle, disc, polygon: 1 if the back is visible too
};
GPU_SIZE(EmitterRecord, 56)
// The corners of a polygon, two per vec4, along its axes. The last one fills the rest of the array.
struct EmitterCorners {
    vec4 pairs[EMITTER_CORNER_PAIRS];
};
GPU_SIZE(EmitterCorners, 64)

// cull_emitters: leaves out emitters that cover no sample. A piece is up to PIECE_EMITTERS
// consecutive emitters of one shape. One lane tests a piece, and writes the emitters that remain,
// from the place of the first one on, and a draw command for them. One dispatch for each shape.
const uint CULL_EMITTERS_GROUP = 8u;
const uint PIECE_EMITTERS = 256u;
const uint CULL_EMITTERS_RECORDS = 1u; // EmitterRecord; binding 0 is RAY_FRAME
const uint CULL_EMITTERS_CORNERS = 2u; // vec4: the same buffer
const uint CULL_EMITTERS_KEPT_RECORDS = 3u;
const uint CULL_EMITTERS_KEPT_CORNERS = 4u; // the same buffer as those records
const uint CULL_EMITTERS_DRAWS = 5u;        // EmitterDraw per piece
struct CullEmittersParams {
    uint shape; // LIGHT_*
    uint first; // of the shape's emitters
    uint count;
    uint firstCorners; // of the polygons, in vec4 from the beginning of the buffer
    uint firstPiece;
    uint pieceCount;
    float snap; // pixels by which the rasteriser may move a vertex
};
GPU_SIZE(CullEmittersParams, 28)

// The same members as VkDrawIndirectCommand.
struct EmitterDraw {
    uint vertexCount;
    uint instanceCount;
    uint firstVertex;
    uint firstInstance; // counted within the shape
};
GPU_SIZE(EmitterDraw, 16)

// --- Specialisation constants
const uint RASTER_TEXTURES = 0u; // sampled meshes: mask of 1 << TEXTURE_*
const uint RASTER_COVERAGE = 1u; // sampled meshes: COVERAGE_*
const uint RASTER_UNLIT = 2u;    // sampled meshes: they emit their base colour and nothing else
const uint RASTER_SHAPE = 0u;    // analytic: ANALYTIC_*; emitters: LIGHT_*

GPU_END

#endif
