#pragma once
/// How many breakpoints a law may have. A run ends a step at each of them, so a law that has thousands of them within
/// one step makes it thousands of times as long as asked for, and one that has millions never ends.
#include <cstddef>
#include <string>

#include "bough/laws/law.hpp"
#include "bough/scene/scene.hpp"

namespace bough::scene {

inline constexpr std::size_t most_breaks_a_step = 1000;  ///< on the average over a stretch
inline constexpr int steps_a_stretch = 64;  ///< breakpoints are looked for stretch by stretch, as the run goes on
inline constexpr std::size_t most_breaks_a_stretch = most_breaks_a_step * steps_a_stretch;

/// End of the stretch that begins at a time [s].
double end_of_stretch(const Analysis& analysis, double begin);

/// What is wrong with a law that has more: "changes branch more than 1000 times a step of 0.001 s between t = 0 and t
/// = 0.064".
std::string too_many_breaks(const Analysis& analysis, double begin);
/// What to do about it.
inline constexpr const char* fewer_breaks =
    "take steps that resolve the law, or a law that is smooth: its mean, or a sine instead of its sign";

}  // namespace bough::scene
