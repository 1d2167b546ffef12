#pragma once
/// Predicts the duration of a walk on any number of threads from the durations of its visits. Internal to study.
#include <vector>

#include "bough/records/profile.hpp"
#include "bough/tree/tree.hpp"

namespace bough::study {

/// Longest sum of `seconds` (by sub-domain) from a leaf to the root. No number of threads can walk faster.
double critical_path(const tree::Tree& walk, const std::vector<double>& seconds);

enum class Direction { up, down };

/// Duration of one walk by greedy list scheduling, longest remaining path first, of the tasks that schedule::Threads
/// makes: subtrees below `grain_flops` whole, all others visit by visit. Hand-over between threads costs nothing
/// here. One thread: the sum.
double eval_walk(const tree::Tree& walk, const std::vector<double>& seconds, Direction direction, int threads,
                 double grain_flops);

/// eval_walk for each of `threads` (ascending). More threads never take longer, since the additional ones may idle.
std::vector<double> eval_walks(const tree::Tree& walk, const std::vector<double>& seconds, Direction direction,
                               const std::vector<int>& threads, double grain_flops);

/// A walk on each of `threads` (ascending): its schedule, and the time that its bytes take at the rate at which so many
/// threads read [bytes/s]. No walk is shorter than either.
records::WalkProfile simulate_walk(const tree::Tree& walk, const std::vector<double>& seconds, Direction direction,
                                   const std::vector<int>& threads, double grain_flops, double bytes,
                                   const std::vector<double>& read_rates);

}  // namespace bough::study
