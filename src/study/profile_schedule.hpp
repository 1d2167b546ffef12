#pragma once
/// What a walk takes on any number of threads, given what its visits take. Internal to study.
#include <vector>

#include "bough/tree/tree.hpp"

namespace bough::study {

/// Longest sum of `seconds` (by sub-domain) from a leaf to the root: no number of threads walks faster.
double critical_path(const tree::Tree& walk, const std::vector<double>& seconds);

enum class Direction { up, down };

/// Duration of one walk by greedy list scheduling, longest remaining path first, of the tasks that schedule::Threads
/// makes: subtrees below `grain_flops` whole, all others visit by visit. Hand-over between threads costs nothing
/// here. One thread: the sum.
double eval_walk(const tree::Tree& walk, const std::vector<double>& seconds, Direction direction, int threads,
                 double grain_flops);

/// eval_walk for each of `threads` (ascending); never more than with fewer, since threads may idle.
std::vector<double> eval_walks(const tree::Tree& walk, const std::vector<double>& seconds, Direction direction,
                               const std::vector<int>& threads, double grain_flops);

}  // namespace bough::study
