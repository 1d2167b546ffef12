#pragma once
/// The motion between recorded frames: cubics through places and velocities, the shorter way between rotations.
#include <array>
#include <span>
#include <vector>

#include "bough/records/run.hpp"

namespace bough::report {

/// Whether the motion between a frame and the one before follows from both: a part has turned little.
inline bool is_followed(const records::MotionFrame& frame) { return frame.turn <= records::largest_turn; }

/// Derivative of a place by time (load factor, step) at frame k, by the parabola through it and its neighbours. For
/// motions without velocities, those of statics. place(frame): three coordinates.
template <class Place>
std::array<double, 3> slope_at(std::span<const records::MotionFrame* const> frames, std::size_t k, const Place& place) {
  const auto quotient = [&](std::size_t a, std::size_t c) {
    const double h = frames[a + 1]->time - frames[a]->time;
    return h > 0.0 ? (place(*frames[a + 1])[c] - place(*frames[a])[c]) / h : 0.0;
  };
  std::array<double, 3> slope{};
  if (frames.size() < 2) return slope;
  for (std::size_t c = 0; c < 3; ++c) {
    if (k == 0 || k + 1 == frames.size()) {
      slope[c] = quotient(k == 0 ? 0 : k - 1, c);
      continue;
    }
    const double before = frames[k]->time - frames[k - 1]->time, after = frames[k + 1]->time - frames[k]->time;
    slope[c] = (after * quotient(k - 1, c) + before * quotient(k, c)) / (before + after);
  }
  return slope;
}

/// The frame at a time. has_velocities: those of the frames are derivatives of the places. Beyond `is_followed` it is
/// the nearer of the two frames beside it.
records::MotionFrame frame_at(const std::vector<records::MotionFrame>& frames, double time, bool has_velocities);

}  // namespace bough::report
