#pragma once
/// Limits of the number of breakpoints of a law. A run ends a step at each breakpoint, so a law with thousands of them
/// within one step makes the run thousands of times longer than requested, and with millions the run never ends.
#include <cstddef>
#include <string>

#include "bough/laws/law.hpp"
#include "bough/scene/scene.hpp"

namespace bough::scene {

inline constexpr std::size_t most_breaks_a_step = 1000;  ///< most breakpoints per step, on the average over a stretch
inline constexpr int steps_a_stretch = 64;  ///< steps in a stretch; the run searches the breakpoints of one stretch
                                            ///< after the other as it proceeds
inline constexpr std::size_t most_breaks_a_stretch = most_breaks_a_step * steps_a_stretch;

/// End [s] of the stretch that begins at time `begin` [s].
double end_of_stretch(const Analysis& analysis, double begin);

/// Message for a law that exceeds the limit: "changes branch more than 1000 times a step of 0.001 s between t = 0 and t
/// = 0.064".
std::string too_many_breaks(const Analysis& analysis, double begin);
/// What to do about it.
inline constexpr const char* fewer_breaks =
    "take steps that resolve the law, or a law that is smooth: its mean, or a sine instead of its sign";

}  // namespace bough::scene
