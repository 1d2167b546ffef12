#pragma once
/// Predicts the duration of a walk on any number of threads from the durations of its visits. Internal to study.
#include <utility>
#include <vector>

#include "bough/records/profile.hpp"
#include "bough/tree/tree.hpp"

namespace bough::study {

/// Times of the visits of a walk on one thread, by sub-domain.
struct VisitTimes {
  std::vector<double> seconds;
  std::vector<double> shared;  ///< of these, in loops that idle threads take part in; empty: none
  std::vector<double> parts;   ///< into how many parts, >= 1
  VisitTimes(std::vector<double> s) : seconds(std::move(s)) {}  // NOLINT(google-explicit-constructor): nothing shared
  VisitTimes(std::vector<double> s, std::vector<double> of_loops, std::vector<double> num_parts)
      : seconds(std::move(s)), shared(std::move(of_loops)), parts(std::move(num_parts)) {}
};

/// Longest sum from a leaf to the root, each shared loop divided into all its parts. No number of threads can walk
/// faster.
double critical_path(const tree::Tree& walk, const VisitTimes& times);

enum class Direction { up, down };

/// Duration of one walk by greedy list scheduling, longest remaining path first, of the tasks that schedule::Threads
/// makes: subtrees below `grain_flops` whole, all others visit by visit. Threads that are idle when a visit begins take
/// part in its loops, as many as these have parts. Hand-over between threads costs nothing here. One thread: the sum.
double eval_walk(const tree::Tree& walk, const VisitTimes& times, Direction direction, int threads, double grain_flops);

/// eval_walk for each of `threads` (ascending). More threads never take longer, since the additional ones may idle.
std::vector<double> eval_walks(const tree::Tree& walk, const VisitTimes& times, Direction direction,
                               const std::vector<int>& threads, double grain_flops);

/// A walk on each of `threads` (ascending): its schedule, and the time that its bytes take at the rate at which so many
/// threads read [bytes/s]. No walk is shorter than either.
records::WalkProfile simulate_walk(const tree::Tree& walk, const VisitTimes& times, Direction direction,
                                   const std::vector<int>& threads, double grain_flops, double bytes,
                                   const std::vector<double>& read_rates);

}  // namespace bough::study
