// SPDX-License-Identifier: Apache-2.0
// The light of scenes that have none.
#pragma once

#include "scene/scene.h"

namespace candelabra::app
{

// Tells whether anything lights the scene: a light with an emission, or an environment.
bool isLit(const Scene& scene);

// Returns a neutral photographic studio as an environment: a soft grey sky, a wide key light above
// to the left of the default camera, a weaker fill to its right, and a narrow light from behind.
// A white surface that faces the key light, and so gets most light, has the luminance `white`.
SceneEnvironment studioEnvironment(const Camera& defaultCamera, float white);

// Returns the luminance in cd/m^2 that white surfaces in the studio have, so that the scene's own
// emission looks right beside them: that of white in unlit materials if there are any and their
// surfaces are at least as large as those that glow, else 1, the luminance of an emissive factor of
// 1 in glTF. Beside unlit surfaces a glow looks black, so the area of a surface that glows at
// less than 1 cd/m^2 counts in proportion to that luminance. Beside a glow everything unlit looks
// white, whatever its colour, so unlit surfaces count with their whole area.
float studioWhite(const Scene& scene);

// Returns the EV100 that a grey card has in the studio where it gets most light, facing the key
// light. With it, black things look black and white ones white, while automatic exposure makes both
// grey; and white things keep their shape, because only highlights are brighter than white.
float studioEv100(float white);

} // namespace candelabra::app
