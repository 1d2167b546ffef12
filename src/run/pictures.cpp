#include "pictures.hpp"

#include <algorithm>
#include <cmath>

namespace bough::run {

namespace {

/// Compressed size of one picture, largest values measured on lattices of 10 512 tubes and rectangular bars. A point of
/// a beam takes 50 bytes in motion.bin (49 to 50). In a VTU file it takes 93 bytes, and 13.2 for each corner of its
/// section (297 to 305 in all with 16 corners, 143 to 147 with 4).
constexpr double bytes_per_point = 50.0, vtu_bytes_per_point = 93.0, vtu_bytes_per_corner = 13.2;

struct PictureBytes {
  double motion = 200.0;  ///< in motion.bin
  double vtu = 4000.0;    ///< in the VTU file for other programs
};

PictureBytes bytes_of(const records::MotionFrame& frame, const records::MotionParts& parts) {
  PictureBytes bytes;
  const auto others = static_cast<double>(frame.bodies.size() + frame.links.size() + frame.arrows.size());
  bytes.motion += 60.0 * others;
  bytes.vtu += 100.0 * others;
  for (const int mesh : parts.bodies)
    if (mesh >= 0) bytes.vtu += 16.0 * static_cast<double>(parts.meshes[static_cast<std::size_t>(mesh)].points.size());
  for (std::size_t k = 0; k < frame.curves.size(); ++k) {
    const auto points = static_cast<double>(frame.curves[k].points.size());
    const int outline = k < parts.curves.size() ? parts.curves[k].outline : -1;
    double corners = 0.0;
    if (outline >= 0)
      for (const auto& loop : parts.outlines[static_cast<std::size_t>(outline)].loops)
        corners += static_cast<double>(loop.size());
    bytes.motion += bytes_per_point * points;
    bytes.vtu += (vtu_bytes_per_point + vtu_bytes_per_corner * corners) * points;
  }
  return bytes;
}

}  // namespace

Pictures::Pictures(const scene::Scene& scene, const plan::Plan& plan, bool is_wanted)
    : is_wanted_(is_wanted),
      follows_path_(scene.analysis.arc_length.has_value()),
      stride_(scene.output.motion_stride),
      end_(plan.is_dynamic ? scene.analysis.end_time : 1.0) {}

bool Pictures::is_passed(double time, int interval) const {
  return time >= (1.0 - 1e-9) * end_ * interval / most_intervals_;
}

/// Room for pictures by turns is given out as time goes on, so that one fast part of a run does not take all.
bool Pictures::has_room(double time) const {
  constexpr int at_once = 50;
  return taken_by_turn_ < std::min<double>(most_by_turn_, at_once + most_by_turn_ * time / end_);
}

bool Pictures::is_due(long row, double time, double turn, bool is_last) const {
  if (!is_wanted_ || is_last) return is_wanted_;
  if (stride_ > 0) return row % stride_ == 0;
  if (follows_path_) return true;  // the length of the path is unknown before its end
  // The first step that ends at or after the next interval is drawn.
  constexpr double turn_between = records::largest_turn / 3.0;  // readers may leave out every second picture
  return row == 0 || is_passed(time, next_) || (turn >= turn_between && has_room(time));
}

std::optional<std::string> Pictures::set_size(const records::MotionFrame& frame, const records::MotionParts& parts,
                                              std::size_t num_states) {
  is_first_ = false;
  if (stride_ > 0) return std::nullopt;
  constexpr double most = 200e6, most_motion = 120e6;
  constexpr double bytes_per_state = 160.0;  // 16 numbers, and a name of some letters with its length
  PictureBytes bytes = bytes_of(frame, parts);
  bytes.vtu += bytes_per_state * static_cast<double>(num_states);
  most_intervals_ = static_cast<int>(std::clamp(most_motion / bytes.motion - 1.0, 2.0, 100.0));
  constexpr double most_pictures = 3000.0;
  most_by_turn_ = static_cast<int>(std::clamp(most_motion / bytes.motion, 0.0, most_pictures)) - most_intervals_;
  const double left = most - bytes.motion * (most_intervals_ + 1);
  others_every_ = static_cast<int>(std::ceil(most_intervals_ / std::max(1.0, left / bytes.vtu - 1.0)));
  if (most_intervals_ == 100 && others_every_ == 1) return std::nullopt;
  return "of the motion " + std::to_string(most_intervals_ + 1) + " pictures are kept, and every " +
         (others_every_ == 1 ? std::string() : std::to_string(others_every_) + "th ") +
         "one as a VTU file, so that all stay below 200 MB; output.motion_stride keeps as many as it says";
}

bool Pictures::take(double time, bool is_last) {
  // What is drawn because it has turned is not passed on: other programs do not draw what lies between pictures.
  if (stride_ == 0 && !follows_path_ && taken_ > 0 && !is_last && !is_passed(time, next_)) {
    ++taken_by_turn_;
    return false;
  }
  const bool is_for_others = taken_++ % others_every_ == 0 || is_last;
  while (next_ < most_intervals_ && is_passed(time, next_)) ++next_;
  return is_for_others;
}

}  // namespace bough::run
