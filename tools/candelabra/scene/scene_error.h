// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace candelabra::app
{

// Thrown for a scene that cannot be used. what() is one sentence that names the file, the element
// and the reason. The program then ends with exit code 2.
struct SceneError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Thrown for a scene that exceeds a limit of the program.
struct SceneTooLarge : SceneError {
    using SceneError::SceneError;
};

} // namespace candelabra::app
