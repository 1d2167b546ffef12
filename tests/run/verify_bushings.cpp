// Bushings act in the axes of their first frame, on the motion of their second: closed forms and invariances.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bough/motion/so3.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::run_ok;
using support::scene_of;
using support::text;

const std::vector<std::string> in_space{"/without=[\"planar\", \"translation\", \"line\"]"};

std::string about(const char* axis, double angle) {
  return std::string(R"("rotation": {"axis": )") + axis + R"(, "angle": )" + text(angle) + "}";
}

/// A box, drawn with turned axes, on a bushing under a force; `first` and `second` are attachments.
std::string box_on_bushing(double turned, const std::string& first, const std::string& second, const std::string& force,
                           const std::string& analysis) {
  return R"({"bodies": [{"name": "box", "mass": 2, "inertia": [0.1, 0.1, 0.1], "position": [5, 0, 0], )" +
         about("[0, 0, 1]", turned) + R"(}], "bushings": [{"name": "mount", "first": )" + first + R"(, "second": )" +
         second + R"(, "stiffness": [1000, 3000, 1e6, 1e6, 1e6, 400], "damping": [2, 3, 20, 2, 2, 0.5]}],
    "loads": [{"at": "box", "force": )" +
         force + R"(}], "sensors": [{"name": "box", "kind": "position", "at": "box"},
      {"name": "turn", "kind": "rotation", "at": "box"}], "analysis": )" +
         analysis + "}";
}
const char* const statics = R"({"kind": "static"})";

// x = f_x / k_1, y = f_y / k_2 along the ground's axes, wherever those of the box are drawn.
TEST(Bushings, act_along_the_axes_of_the_ground_where_that_is_first) {
  for (const std::vector<std::string>& way : {std::vector<std::string>{}, in_space})
    for (const double turned : {0.0, 0.6, 1.5707963267948966, 2.7, -3.0}) {
      SCOPED_TRACE(turned);
      const auto h =
          run_ok(scene_of(box_on_bushing(turned, R"("ground")", R"("box")", "[1, 1.5, 0]", statics), way)).history;
      EXPECT_NEAR(h.last("box.x"), 5.0 + 1.0 / 1000.0, 1e-9);
      EXPECT_NEAR(h.last("box.y"), 1.5 / 3000.0, 1e-9);
    }
}

// With the box first its own axes count, and they may be given: x along (cos a, sin a).
TEST(Bushings, act_along_the_axes_of_a_body_that_is_first_or_along_those_given_there) {
  for (const std::vector<std::string>& way : {std::vector<std::string>{}, in_space})
    for (const double turned : {0.3, 0.6, -2.0}) {
      SCOPED_TRACE(turned);
      const double c = std::cos(turned), s = std::sin(turned);
      const auto own =
          run_ok(scene_of(box_on_bushing(turned, R"("box")", R"("ground")", "[1, 0, 0]", statics), way)).history;
      EXPECT_NEAR(own.last("box.x") - 5.0, c * c / 1000.0 + s * s / 3000.0, 2e-8);
      EXPECT_NEAR(own.last("box.y"), c * s / 1000.0 - c * s / 3000.0, 2e-8);
      const std::string given = R"({"to": "ground", )" + about("[0, 0, 1]", turned) + "}";
      const auto told = run_ok(scene_of(box_on_bushing(0.9, given, R"("box")", "[1, 0, 0]", statics), way)).history;
      EXPECT_NEAR(told.last("box.x") - 5.0, c * c / 1000.0 + s * s / 3000.0, 1e-9);
      EXPECT_NEAR(told.last("box.y"), c * s / 1000.0 - c * s / 3000.0, 1e-9);
    }
}

// Large motions in time: where the second's axes are drawn changes nothing, in a plane and in space.
TEST(Bushings, move_a_body_alike_wherever_its_axes_are_drawn) {
  const char* const dynamics = R"({"kind": "dynamic", "end_time": 0.5, "step_size": 0.005})";
  const std::string place = R"({"to": "box", "position": [0, 0, 0]})";
  for (const std::vector<std::string>& way : {std::vector<std::string>{}, in_space}) {
    const Outcome straight = run_ok(scene_of(box_on_bushing(0.0, R"("ground")", place, "[60, 90, 0]", dynamics), way));
    const Outcome turned = run_ok(scene_of(box_on_bushing(0.8, R"("ground")", place, "[60, 90, 0]", dynamics), way));
    EXPECT_GT(std::abs(straight.history.last("box.x") - 5.0), 1e-3);
    for (const char* column : {"box.x", "box.y"})
      EXPECT_NEAR(turned.history.last(column), straight.history.last(column), 1e-9) << column;
    EXPECT_NEAR(turned.history.last("turn.rz"), 0.8 + straight.history.last("turn.rz"), 1e-9);
  }
}

// In space: the whole scene turned and moved by Q gives the motion turned and moved by Q.
TEST(Bushings, turn_with_the_whole_scene) {
  const scene::Scene scene = scene_of(R"({
    "bodies": [{"name": "base", "mass": 3, "inertia": [0.2, 0.3, 0.4], "rotation": {"axis": [0, 1, 1], "angle": 0.5}},
               {"name": "box", "mass": 2, "inertia": [0.1, 0.2, 0.15], "position": [0.2, 0.1, 0.3],
                "rotation": {"axis": [1, 0, 2], "angle": 1.1}}],
    "bushings": [{"name": "b", "first": "base", "second": "box", "stiffness": [100, 400, 900, 5, 7, 9]},
                 {"name": "c", "first": "ground", "second": "base", "stiffness": [300, 200, 100, 15, 17, 19]}],
    "loads": [{"at": "box", "force": [3, -2, 4], "moment": [0.2, 0.1, -0.1]}],
    "sensors": [{"name": "box", "kind": "position", "at": "box"}],
    "analysis": {"kind": "dynamic", "end_time": 0.4, "step_size": 0.004}})");
  const scene::Frame to{motion::exp_so3(scene::Vec3{{0.5, -0.8, 0.3}}), scene::Vec3{{1.0, 2.0, -1.0}}};
  const auto place = [](const Outcome& run) {
    return scene::Vec3{{run.history.last("box.x"), run.history.last("box.y"), run.history.last("box.z")}};
  };
  const scene::Vec3 expected = motion::transform(to, place(run_ok(scene))),
                    got = place(run_ok(support::moved(scene, to)));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], expected[k], 1e-9) << k;
}

// A force on a mast acts on its middle: the bushing takes what the middle moves by, k u, however far the ground's
// origin is from it, and whichever way the mast's section is turned. u = F / (k + 3 E I / l^3) below the middle.
TEST(Bushings, take_the_motion_of_the_second_however_far_the_first_is) {
  for (const char* axis : {"[0, 1, 0]", "[1, 1, 0]", "[1, 0, 0]"}) {
    const auto h = run_ok(scene_of(std::string(R"({
      "sections": [{"name": "s", "stiffness": {"EA": 1e9, "GA2": 1e12, "GA3": 1e12, "GJ": 1e6, "EI2": 1e6, "EI3": 1e6}}],
      "nodes": [{"name": "a"}, {"name": "b", "position": [0, 0, 2]}],
      "beams": [{"name": "mast", "section": "s", "start": "a", "end": "b", "elements": 64, "axis_2": )") +
                                   axis + R"(}],
      "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "a"}],
      "bushings": [{"name": "inner", "first": {"to": "ground", "position": [0, 0, 0]},
                    "second": {"to": "mast.32", "position": [0, 0, 0]}, "stiffness": [1e7, 0, 0, 0, 0, 0]}],
      "loads": [{"at": "mast.32", "force": [1000, 0, 0]}],
      "sensors": [{"name": "mid", "kind": "position", "at": "mast.32"}],
      "analysis": {"kind": "static"}})"))
                       .history;
    EXPECT_NEAR(h.last("mid.x"), 1000.0 / (1e7 + 3e6), 2e-8) << axis;
  }
}

}  // namespace
}  // namespace bough::run
