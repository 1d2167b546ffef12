#pragma once
/// Scenes of a row of links, with and without what left_out.py asks for.
#include <vector>

#include "bough/scene/scene.hpp"

namespace lean {

/// With the names that left_out.py knows them by.
std::vector<bough::scene::Scene> make_scenes();

}  // namespace lean
