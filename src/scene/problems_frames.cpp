#include <cmath>

#include "bough/scene/analysis_kinds.hpp"
#include "bough/scene/moving_frame.hpp"
#include "problem_list.hpp"

namespace bough::scene {
namespace {

void check_frame_laws(ProblemList& list, std::size_t i) {
  const FrameDef& f = list.scene.frames[i];
  if (!f.motion) return;
  static const char* const keys[3] = {"position/0", "position/1", "position/2"};
  for (int k = 0; k < 3; ++k) list.check_law("frames", i, keys[k], f.motion->position[k], true);
  for (std::size_t k = 0; k < f.motion->turns.size(); ++k)
    list.check_law("frames", i, "turns/" + std::to_string(k) + "/angle", f.motion->turns[k].angle, true);
}

/// The quantities that determine the inertial loads in a frame, in its own axes: angular velocity and acceleration,
/// acceleration of the origin, gravity.
struct Loading {
  Vec3 turning, angular, origin, gravity;
};

Loading loading_at(const Scene& scene, const std::vector<std::size_t>& way, double time) {
  std::vector<motion::FrameMotion> links;
  for (auto i = way.rbegin(); i != way.rend(); ++i) {
    const FrameDef& f = scene.frames[*i];
    motion::FrameMotion m;
    m.pose = f.placement.pose;
    links.push_back(f.motion ? motion_at(*f.motion, time) : m);
  }
  const motion::FrameChain chain(std::move(links));
  const motion::FrameMotion m = motion::relative_motion(chain, motion::Of(chain.last()), motion::RelativeTo(0));
  const auto own = [&m](const Vec3& x) { return lanes::transpose_times(m.pose.R, x); };
  return {own(m.angular_velocity), own(m.angular_acceleration), own(m.acceleration), own(scene.gravity)};
}

/// Statics needs inertial loads that are constant in time. This is judged by samples over one second.
void check_steady(ProblemList& list, const std::vector<std::size_t>& way) {
  constexpr int samples = 8;
  constexpr double tolerance = 1e-9;
  const Loading start = loading_at(list.scene, way, 0.0);
  for (int k = 0; k <= samples; ++k) {
    const double t = static_cast<double>(k) / samples;
    const Loading now = loading_at(list.scene, way, t);
    const double rate = norm(start.turning);
    const auto differs = [](const Vec3& a, const Vec3& b, double scale) {
      return !(norm(a - b) <= tolerance * (norm(b) + scale));
    };
    std::string what;
    if (differs(now.turning, start.turning, 0.0) || !(norm(now.angular) <= tolerance * rate * rate))
      what = "angular velocity";
    else if (differs(now.origin, start.origin, rate * rate * list.size))
      what = "acceleration";
    else if (differs(now.gravity, start.gravity, 0.0))
      what = "gravity";
    if (what.empty()) continue;
    list.add("analysis", 0, "frame", list.scene.analysis.frame,
             "statics in a moving frame needs a steady motion: its " + what +
                 ", in its own axes, changes by t = " + text_of(t) + " s",
             "compute it as a motion in time (\"kind\": \"dynamic\")");
    return;
  }
}

}  // namespace

void check_frames(ProblemList& list) {
  const Scene& s = list.scene;
  for (std::size_t i = 0; i < s.frames.size(); ++i) check_frame_laws(list, i);
  const std::string& name = s.analysis.frame;
  if (name.empty() || list.is_defective(name)) return;
  if (!list.check_reference("analysis", 0, "frame", name, list.frames, "frame")) return;
  const std::vector<std::size_t>& way = list.poses.frames().above_ground();
  const std::string& last = s.frames[way.back()].placement.frame;
  const bool is_whole = last.empty() || last == "ground";  // otherwise another problem has been reported already
  if (is_whole && !type_of(s.analysis.kind).is_in_time) check_steady(list, way);
}

}  // namespace bough::scene
