#pragma once
/// Motions of linkages in words. Internal to plan.
#include <string>
#include <vector>

#include "linkage_of.hpp"

namespace bough::plan {

inline constexpr double still = 1e-7;   ///< relative: smaller twists are round-off of null vectors
inline constexpr std::size_t told = 4;  ///< largest number of notes of one kind
inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Describes a motion: which parts move, how, and at which joints.
std::string describe(const SceneLinkage& s, const LinkComponent& c, Eigen::Index motion, const char* between);

/// Names of the beams, and of the nodes and bodies that belong to no beam.
std::vector<std::string> names_in(const SceneLinkage& s, const LinkComponent& c);

}  // namespace bough::plan
