// Sectional forces at every station of a beam, not only at nodes, against closed forms and equilibrium.
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
using Vec3 = scene::Vec3;

struct Mesh {
  int order, elements;
  std::string text() const {
    return R"("order": )" + std::to_string(order) + R"(, "elements": )" + std::to_string(elements);
  }
};
const Mesh meshes[] = {{1, 1}, {1, 3}, {1, 8}, {2, 1}, {2, 3}, {3, 1}, {3, 2}, {3, 5}};

const double stations[] = {0.0, 0.07, 0.2, 0.25, 1.0 / 3.0, 0.41, 0.5, 0.62, 0.75, 0.9, 0.99, 1.0};

/// Sensors of beam "b" at all stations, named by their number: forces f, strains e, places x and rotations r.
std::string sensors() {
  std::string list;
  int k = 0;
  for (const double station : stations) {
    const auto add = [&](const char* name, const char* kind) {
      list += (list.empty() ? "" : ", ") + std::string(R"({"name": ")") + name + std::to_string(k) + R"(", "kind": ")" +
              kind + R"(", "beam": "b", "station": )" + text(station) + "}";
    };
    add("f", "section_force");
    add("e", "section_strain");
    add("x", "position");
    add("r", "rotation");
    ++k;
  }
  return list;
}

Vec3 vector_of(const Outcome& run, const std::string& sensor, const std::vector<std::string>& components) {
  Vec3 v;
  for (int k = 0; k < 3; ++k) v[k] = run.history.last(sensor + "." + components[static_cast<std::size_t>(k)]);
  return v;
}
/// A force or moment of a section in the axes of the ground, and its place.
struct Section {
  Vec3 force, moment, place;
  motion::Mat3<double> R;
};
Section section_of(const Outcome& run, std::size_t k) {
  const std::string n = std::to_string(k);
  Section s;
  s.R = motion::exp_so3(vector_of(run, "r" + n, {"rx", "ry", "rz"}));
  s.force = s.R * vector_of(run, "f" + n, {"N", "Q2", "Q3"});
  s.moment = s.R * vector_of(run, "f" + n, {"T", "M2", "M3"});
  s.place = vector_of(run, "x" + n, {"x", "y", "z"});
  return s;
}
void expect_near(const Vec3& got, const Vec3& expected, double tolerance, const char* what) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], expected[k], tolerance) << what << " " << k;
}

const char* const stiff = R"("sections": [{"name": "s", "stiffness": {"EA": 1e8, "GA2": 1e8, "GA3": 1e8, "GJ": 1e6,
  "EI2": 1e6, "EI3": 1e6}, "mass": {"mass_per_length": 50}}])";
const char* const soft = R"("sections": [{"name": "s", "stiffness": {"EA": 1e5, "GA2": 1e5, "GA3": 1e5, "GJ": 8,
  "EI2": 10, "EI3": 14}, "mass": {"mass_per_length": 0.5}}])";

// Two supports, a load along the whole beam: M = q x (L - x) / 2, Q = q (L / 2 - x), for every mesh at every station.
TEST(SectionForces, of_a_beam_on_two_supports_are_the_parabola_of_its_load) {
  const double q = 1000.0, L = 4.0;
  for (const Mesh& mesh : meshes) {
    SCOPED_TRACE(mesh.text());
    const Outcome run = run_ok(scene_of(std::string("{") + stiff + R"(,
      "nodes": [{"name": "a"}, {"name": "z", "position": [4, 0, 0]}],
      "beams": [{"name": "b", "section": "s", "start": "a", "end": "z", )" +
                                        mesh.text() + R"(}],
      "joints": [{"name": "pin", "kind": "revolute", "first": "ground", "second": "a", "axis": [0, 1, 0]}],
      "motions": [{"at": "z", "z": 0}],
      "loads": [{"beam": "b", "force": [0, 0, -600]}, {"beam": "b", "force": [0, 0, -400]}],
      "sensors": [)" + sensors() + R"(], "analysis": {"kind": "static", "tolerance": 1e-11}})"));
    for (std::size_t k = 0; k < std::size(stations); ++k) {
      const double x = stations[k] * L;
      SCOPED_TRACE(x);
      const Section s = section_of(run, k);
      EXPECT_NEAR(std::abs(s.moment[1]), 0.5 * q * x * (L - x), 6e-3) << "supports move by 1e-5 of L as it bends";
      EXPECT_NEAR(s.force[2], q * (x - 0.5 * L), 5e-5) << "on the part before the section";
    }
  }
}

// M = q x (L - x) / 2 has its extreme q L^2 / 8 in the middle, M = P x (1 - a / L) its own under the load, where Q jumps
// by P; between nodes, on them and within elements of every order.
TEST(SectionForces, have_their_extremes_where_closed_forms_have_them) {
  const double q = 1000.0, P = 3000.0, L = 4.0;
  for (const Mesh& mesh : {Mesh{1, 1}, Mesh{1, 3}, Mesh{1, 8}, Mesh{2, 1}, Mesh{2, 2}, Mesh{3, 1}, Mesh{3, 4}}) {
    SCOPED_TRACE(mesh.text());
    const auto extremes = [&mesh](const std::string& load) {
      return run_ok(scene_of(std::string("{") + stiff + R"(,
        "nodes": [{"name": "a"}, {"name": "z", "position": [4, 0, 0]}],
        "beams": [{"name": "b", "section": "s", "start": "a", "end": "z", )" +
                             mesh.text() + R"(}],
        "joints": [{"name": "pin", "kind": "revolute", "first": "ground", "second": "a", "axis": [0, 1, 0]}],
        "motions": [{"at": "z", "z": 0}], "loads": [)" +
                             load + R"(],
        "sensors": [{"name": "M", "kind": "section_force_extremes", "beam": "b", "component": "M2"},
                    {"name": "Q", "kind": "section_force_extremes", "beam": "b", "component": "Q3"}],
        "analysis": {"kind": "static", "tolerance": 1e-11}})"));
    };
    const auto far_from_zero = [](const Outcome& run, const std::string& name) {
      const double least = run.history.last(name + ".least"), largest = run.history.last(name + ".largest");
      const bool is_least = -least > largest;
      return std::pair{is_least ? -least : largest, run.history.last(name + (is_least ? ".least_at" : ".largest_at"))};
    };
    const Outcome uniform = extremes(R"({"beam": "b", "force": [0, 0, -1000]})");
    const auto [moment, place] = far_from_zero(uniform, "M");
    EXPECT_NEAR(moment, q * L * L / 8.0, 6e-3);
    EXPECT_NEAR(place, 0.5, 1e-6);
    // In the axes of sections, which turn by 2.7e-3 at the supports.
    EXPECT_NEAR(uniform.history.last("Q.least"), -0.5 * q * L, 1e-2);
    EXPECT_NEAR(uniform.history.last("Q.largest"), 0.5 * q * L, 1e-2);
    EXPECT_NEAR(uniform.history.last("Q.largest_at") + uniform.history.last("Q.least_at"), 1.0, 1e-12);
    const int nodes = mesh.order * mesh.elements;
    if (nodes < 2) continue;
    const double a = L / nodes;
    const Outcome at_node = extremes(R"({"at": "b.1", "force": [0, 0, -3000]})");
    const auto [peak, under] = far_from_zero(at_node, "M");
    EXPECT_NEAR(peak, P * a * (L - a) / L, 2e-2);
    EXPECT_NEAR(under, 1.0 / nodes, 1e-6);
    EXPECT_NEAR(at_node.history.last("Q.largest") - at_node.history.last("Q.least"), P, 1e-2);  // axes turn, too
  }
}

// A heavy soft cantilever, bent by far more than its length over ten: the force is the weight beyond, (L - s) q, straight
// down, whatever the section's axes.
TEST(SectionForces, of_a_bent_cantilever_carry_the_loads_beyond_exactly) {
  for (const Mesh& mesh : meshes) {
    SCOPED_TRACE(mesh.text());
    const Outcome run = run_ok(scene_of(std::string("{") + soft + R"(, "gravity": [0, 0, -10],
      "nodes": [{"name": "a"}, {"name": "z", "position": [2, 0, 0]}],
      "beams": [{"name": "b", "section": "s", "start": "a", "end": "z", )" +
                                        mesh.text() + R"(}],
      "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "a"}],
      "loads": [{"beam": "b", "force": [0, 3, -4]}, {"at": "z", "force": [1, 2, 3]}],
      "sensors": [)" + sensors() + R"(], "analysis": {"kind": "static", "load_steps": 8, "tolerance": 1e-11}})"));
    for (std::size_t k = 0; k < std::size(stations); ++k) {
      SCOPED_TRACE(stations[k]);
      const double beyond = 2.0 * (1.0 - stations[k]);
      const Section s = section_of(run, k);
      expect_near(s.force, {{1.0, 2.0 + 3.0 * beyond, 3.0 - (4.0 + 5.0) * beyond}}, 2e-7, "force");
      if (k + 1 == std::size(stations)) continue;
      const Section tip = section_of(run, std::size(stations) - 1);
      if (k + 2 < std::size(stations)) continue;
      // Near the tip the beam beyond is straight: the arms of the load there are those of its middle.
      const Vec3 arm = 0.5 * (tip.place - s.place), whole = tip.place - s.place;
      const Vec3 moment =
          lanes::cross(arm, Vec3{{0.0, 3.0 * beyond, -9.0 * beyond}}) + lanes::cross(whole, Vec3{{1.0, 2.0, 3.0}});
      expect_near(s.moment, moment, 5e-5, "moment");  // of 20 N m at the wall, with the quadrature of one element
    }
  }
}

// A quarter of a circle, clamped, with a force at its end: n = F, m = (x_end - x) x F in space, inside curved elements.
TEST(SectionForces, of_a_curved_cantilever_are_those_of_the_force_at_its_end) {
  const Vec3 F{{0.3, -0.7, 0.5}};
  for (const Mesh& mesh : meshes) {
    SCOPED_TRACE(mesh.text());
    const Outcome run = run_ok(scene_of(std::string("{") + soft + R"(,
      "nodes": [{"name": "a"}, {"name": "z", "position": [1, 1, 0], "rotation": {"axis": [0, 0, 1], "angle": 1.5707963267948966}}],
      "beams": [{"name": "b", "section": "s", "start": "a", "end": "z", "axis_2": [0, 1, 0],
        "curve": {"curvature": [0, 0, 1], "length": 1.5707963267948966, "tangent": [1, 0, 0]}, )" +
                                        mesh.text() + R"(}],
      "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "a"}],
      "loads": [{"at": "z", "force": [0.3, -0.7, 0.5]}],
      "sensors": [)" + sensors() + R"(], "analysis": {"kind": "static", "load_steps": 4, "tolerance": 1e-11}})"));
    const Section tip = section_of(run, std::size(stations) - 1);
    for (std::size_t k = 0; k < std::size(stations); ++k) {
      SCOPED_TRACE(stations[k]);
      const Section s = section_of(run, k);
      expect_near(s.force, F, 1e-8, "force");
      expect_near(s.moment, lanes::cross(Vec3(tip.place - s.place), F), 1e-8, "moment");
    }
  }
}

// Loads that follow: the force at a station is the integral of R q beyond it, here from as many sensors as Gauss's rule
// of a dense mesh needs.
TEST(SectionForces, of_loads_that_follow_the_beam_are_their_integral_along_its_shape) {
  const int count = 200;
  std::string dense;
  for (int k = 0; k <= count; ++k) {
    const std::string at = R"("beam": "b", "station": )" + text(static_cast<double>(k) / count) + "}";
    dense += (k > 0 ? ", " : "") + std::string(R"({"name": "f)") + std::to_string(k) +
             R"(", "kind": "section_force", )" + at + R"(, {"name": "r)" + std::to_string(k) +
             R"(", "kind": "rotation", )" + at + R"(, {"name": "x)" + std::to_string(k) + R"(", "kind": "position", )" +
             at;
  }
  for (const Mesh& mesh : {Mesh{1, 4}, Mesh{2, 2}, Mesh{3, 2}}) {
    SCOPED_TRACE(mesh.text());
    const Outcome run = run_ok(scene_of(std::string("{") + soft + R"(,
      "nodes": [{"name": "a"}, {"name": "z", "position": [2, 0, 0]}],
      "beams": [{"name": "b", "section": "s", "start": "a", "end": "z", )" +
                                        mesh.text() + R"(}],
      "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "a"}],
      "loads": [{"beam": "b", "axes": "body", "force": [0, 1, -5]}, {"beam": "b", "axes": "body", "force": [0.5, 0, 1],
                 "moment": [0, 0.3, 0]}],
      "sensors": [)" + dense + R"(], "analysis": {"kind": "static", "load_steps": 10, "tolerance": 1e-11}})"));
    const double h = 2.0 / count;
    Vec3 force = Vec3::zero(), moment_about_origin = Vec3::zero();
    Section next = section_of(run, count);
    for (int k = count - 1; k >= 0; --k) {
      const Section s = section_of(run, static_cast<std::size_t>(k));
      for (const Section* end : std::initializer_list<const Section*>{&s, &next}) {
        const Vec3 q = end->R * Vec3{{0.5, 1.0, -4.0}}, m = end->R * Vec3{{0.0, 0.3, 0.0}};
        force += (0.5 * h) * q;
        moment_about_origin += (0.5 * h) * (lanes::cross(end->place, q) + m);
      }
      next = s;
      expect_near(s.force, force, 2e-3, "force");
      expect_near(s.moment, moment_about_origin - lanes::cross(s.place, force), 3e-3, "moment");
    }
  }
}

// In the frame of a turning rod: N = m w^2 (L^2 - x^2) / 2 with inertia alone.
TEST(SectionForces, of_a_rod_in_its_turning_frame_are_the_parabola_of_its_centrifugal_forces) {
  for (const Mesh& mesh : meshes) {
    SCOPED_TRACE(mesh.text());
    const Outcome run = run_ok(scene_of(std::string("{") + stiff + R"(,
      "frames": [{"name": "turning", "turns": [{"axis": [0, 0, 1], "angle": {"expression": "3*t"}}]}],
      "nodes": [{"name": "a"}, {"name": "z", "position": [2, 0, 0]}],
      "beams": [{"name": "b", "section": "s", "start": "a", "end": "z", )" +
                                        mesh.text() + R"(}],
      "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "a"}],
      "sensors": [)" + sensors() + R"(], "analysis": {"kind": "static", "frame": "turning"}})"));
    for (std::size_t k = 0; k < std::size(stations); ++k) {
      const double x = 2.0 * stations[k];
      EXPECT_NEAR(run.history.last("f" + std::to_string(k) + ".N"), 0.5 * 50.0 * 9.0 * (4.0 - x * x), 0.02)
          << "stretched by 1e-5 at " << x;
    }
  }
}

// A force on an inner node of one element: the shear jumps there, and the moment bends.
TEST(SectionForces, jump_at_a_force_on_an_inner_node) {
  const Outcome run = run_ok(scene_of(std::string("{") + stiff + R"(,
    "nodes": [{"name": "a"}, {"name": "z", "position": [3, 0, 0]}],
    "beams": [{"name": "b", "section": "s", "start": "a", "end": "z", "order": 3, "elements": 1}],
    "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "a"}],
    "loads": [{"at": "b.1", "force": [0, 0, -100]}],
    "sensors": [)" + sensors() + R"(], "analysis": {"kind": "static"}})"));
  for (std::size_t k = 0; k < std::size(stations); ++k) {
    const double x = 3.0 * stations[k];
    if (std::abs(x - 1.0) < 1e-9) continue;
    const Section s = section_of(run, k);
    EXPECT_NEAR(s.force[2], x < 1.0 ? -100.0 : 0.0, 1e-6) << x;
    EXPECT_NEAR(std::abs(s.moment[1]), x < 1.0 ? 100.0 * (1.0 - x) : 0.0, 1e-3) << x;
  }
}

// Strains are those of the forces: M / EI, N / EA, Q / GA; pictures hold the same numbers as sensors.
TEST(SectionForces, strains_and_pictures_hold_what_the_forces_say) {
  struct KeepLast : records::Recorder {
    records::MotionFrame last;
    void begin(const records::HistoryHeader&) override {}
    void row(const records::HistoryRow&) override {}
    void motion(const records::MotionFrame& frame) override { last = frame; }
    void end(const records::Summary&) override {}
  };
  for (const Mesh& mesh : meshes) {
    SCOPED_TRACE(mesh.text());
    const scene::Scene scene = scene_of(std::string("{") + soft + R"(, "gravity": [0, 0, -10],
      "nodes": [{"name": "a"}, {"name": "z", "position": [2, 0, 0]}],
      "beams": [{"name": "b", "section": "s", "start": "a", "end": "z", )" +
                                        mesh.text() + R"(}],
      "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "a"}],
      "loads": [{"beam": "b", "force": [0, 3, -4]}], "sensors": [)" +
                                        sensors() + R"(], "output": {"motion": true},
      "analysis": {"kind": "static", "load_steps": 4}})");
    const Outcome run = run_ok(scene);
    const double stiffness[] = {1e5, 1e5, 1e5, 8.0, 10.0, 14.0};
    const char* const forces[] = {"N", "Q2", "Q3", "T", "M2", "M3"};
    const char* const strains[] = {"e1", "g2", "g3", "k1", "k2", "k3"};
    for (std::size_t k = 0; k < std::size(stations); ++k)
      for (std::size_t c = 0; c < 6; ++c)
        EXPECT_NEAR(run.history.last("e" + std::to_string(k) + "." + strains[c]) * stiffness[c],
                    run.history.last("f" + std::to_string(k) + "." + forces[c]), 1e-9);
    KeepLast recorder;
    (void)simulate(scene, {}, recorder);
    const std::vector<records::CurvePoint>& points = recorder.last.curves.at(0).points;
    const double last = static_cast<double>(points.size() - 1);  // loads are integrated from point to point there
    for (std::size_t k = 0; k < std::size(stations); ++k) {
      const auto point = static_cast<std::size_t>(std::lround(stations[k] * last));
      if (std::abs(static_cast<double>(point) - stations[k] * last) > 1e-9) continue;
      for (std::size_t c = 0; c < 6; ++c) {
        EXPECT_NEAR(points[point].force[c], run.history.last("f" + std::to_string(k) + "." + forces[c]), 1e-6);
        EXPECT_NEAR(points[point].strain[c], run.history.last("e" + std::to_string(k) + "." + strains[c]), 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace bough::run
