#include "between_frames.hpp"

#include <algorithm>
#include <cmath>

#include "bough/motion/so3.hpp"

namespace bough::report {
namespace {

using records::MotionFrame;
using Mat3 = motion::Mat3<double>;
using Vec3 = motion::Vec3<double>;

Mat3 matrix_of(const double* axes) {
  Mat3 R;
  std::copy_n(axes, 9, R.m);
  return R;
}

/// Rotates along the shortest rotation from one orientation to the other, by a fraction s. Returns the turn in space.
Mat3 turn(double* axes, const double* next, double s) {
  const Mat3 R = matrix_of(axes), Q = motion::exp_so3(s * motion::log_so3(matrix_of(next) * lanes::transpose(R)));
  const Mat3 between = Q * R;
  std::copy_n(between.m, 9, axes);
  return Q;
}

/// A frame between two of a motion, made from a copy of the first.
class Between {
 public:
  /// frames: up to two on both sides of the time; first: the one before it.
  Between(std::span<const MotionFrame* const> frames, std::size_t first, double time, bool has_velocities)
      : frames_(frames), first_(first), has_velocities_(has_velocities), at_(*frames[first]) {
    h_ = frames[first + 1]->time - at_.time;
    s_ = (time - at_.time) / h_;
    at_.time = time;
  }

  MotionFrame make() {
    const MotionFrame& next = *frames_[first_ + 1];
    for (std::size_t c = 0; c < at_.curves.size(); ++c)
      for (std::size_t k = 0; k < at_.curves[c].points.size(); ++k) {
        place(
            [ c, k ](auto& f) -> auto& { return f.curves[c].points[k].position; },
            [ c, k ](auto& f) -> auto& { return f.curves[c].points[k].velocity; });
        turn(at_.curves[c].points[k].axes, next.curves[c].points[k].axes, s_);
      }
    for (std::size_t b = 0; b < at_.bodies.size(); ++b) move_body(at_.bodies[b], next.bodies[b], b);
    for (std::size_t k = 0; k < at_.links.size(); ++k) {
      place(
          [k](auto& f) -> auto& { return f.links[k].first; },
          [k](auto& f) -> auto& { return f.links[k].first_velocity; });
      place(
          [k](auto& f) -> auto& { return f.links[k].second; },
          [k](auto& f) -> auto& { return f.links[k].second_velocity; });
      turn(at_.links[k].axes, next.links[k].axes, s_);
    }
    for (std::size_t k = 0; k < at_.frames.size(); ++k) {
      place(
          [k](auto& f) -> auto& { return f.frames[k].position; },
          [k](auto& f) -> auto& { return f.frames[k].velocity; });
      turn(at_.frames[k].axes, next.frames[k].axes, s_);
    }
    for (std::size_t k = 0; k < at_.arrows.size(); ++k) {
      place(
          [k](auto& f) -> auto& { return f.arrows[k].position; },
          [k](auto& f) -> auto& { return f.arrows[k].velocity; });
      mix(at_.arrows[k].force, next.arrows[k].force);
      mix(at_.arrows[k].moment, next.arrows[k].moment);
    }
    return std::move(at_);
  }

 private:
  void mix(double* x, const double* next) const {
    for (std::size_t c = 0; c < 3; ++c) x[c] += s_ * (next[c] - x[c]);
  }
  template <class Place, class Velocity>
  std::array<double, 3> slope(std::size_t k, const Place& place, const Velocity& velocity) const {
    if (!has_velocities_) return slope_at(frames_, k, place);
    const double* v = velocity(*frames_[k]);
    return {v[0], v[1], v[2]};
  }
  template <class Place, class Velocity>
  void place(const Place& place, const Velocity& velocity) {
    const std::array<double, 3> v = slope(first_, place, velocity), w = slope(first_ + 1, place, velocity);
    const double *x = place(*frames_[first_]), *y = place(*frames_[first_ + 1]);
    double* at = place(at_);
    for (std::size_t c = 0; c < 3; ++c) {
      const double chord = y[c] - x[c], a = h_ * v[c] - chord, b = h_ * w[c] - chord;
      at[c] = x[c] + s_ * chord + s_ * (1.0 - s_) * ((1.0 - s_) * a - s_ * b);
    }
  }
  /// What is fixed to a body turns with it about its centre of mass.
  void move_body(records::BodyPose& body, const records::BodyPose& next, std::size_t b) {
    Vec3 before, after;
    std::copy_n(body.center, 3, before.v);
    place(
        [b](auto& f) -> auto& { return f.bodies[b].center; }, [b](auto& f) -> auto& { return f.bodies[b].velocity; });
    std::copy_n(body.center, 3, after.v);
    const Mat3 Q = turn(body.axes, next.axes, s_);
    const auto carry = [&](double* x) {
      Vec3 arm;
      for (int c = 0; c < 3; ++c) arm[c] = x[c] - before[c];
      arm = Q * arm;
      for (int c = 0; c < 3; ++c) x[c] = after[c] + arm[c];
    };
    carry(body.position);
    for (auto& place : body.attachments) carry(place.data());
  }

  std::span<const MotionFrame* const> frames_;
  std::size_t first_;
  bool has_velocities_;
  double h_ = 0.0, s_ = 0.0;
  MotionFrame at_;
};

}  // namespace

MotionFrame frame_at(const std::vector<MotionFrame>& frames, double time, bool has_velocities) {
  const auto after =
      std::find_if(frames.begin(), frames.end(), [time](const MotionFrame& f) { return f.time >= time; });
  if (after == frames.begin()) return frames.front();
  if (after == frames.end()) return frames.back();
  const auto before = after - 1;
  if (!is_followed(*after)) return time - before->time < after->time - time ? *before : *after;
  std::vector<const MotionFrame*> near;
  if (before != frames.begin() && is_followed(*before)) near.push_back(&*(before - 1));
  const std::size_t first = near.size();
  near.push_back(&*before);
  near.push_back(&*after);
  if (after + 1 != frames.end() && is_followed(*(after + 1))) near.push_back(&*(after + 1));
  return Between(near, first, time, has_velocities).make();
}

}  // namespace bough::report
