/// Arches and frames that buckle and snap through, driven by a displacement, against boundary value problems.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "bench.hpp"
#include "bough/laws/make_law.hpp"
#include "bough/scene/parts.hpp"
#include "planar_rod.hpp"

namespace bough::stress {

namespace {

constexpr double pi = std::numbers::pi;

scene::PrescribedMotion pushed_down(const std::string& node, double depth) {
  scene::PrescribedMotion down;
  down.name = "down";
  down.at.to = node;
  down.displacement[1] = laws::make_ramp(0.0, 1.0, 0.0, -depth);
  return down;
}

constexpr double arch_radius = 100.0, arch_half = 0.5 * 215.0 * pi / 180.0, arch_EI = 1e6, arch_EA = 1e8;

/// Clamped at the left, hinged at the right; the crown goes down and as far as it likes sideways.
scene::Scene arch(double depth, int load_steps) {
  const double R = arch_radius, half = arch_half;
  const Vec3 left{{-R * std::sin(half), R * std::cos(half), 0.0}}, right{{R * std::sin(half), R * std::cos(half), 0.0}};
  scene::Scene s;
  s.name = "arch";
  s.sections = {scene::make_section("s", arch_EA, arch_EA, arch_EA, arch_EI, arch_EI, arch_EI)};
  s.nodes = {scene::make_node("left", left), scene::make_node("crown", {{0, R, 0}}), scene::make_node("right", right)};
  s.beams = {scene::make_beam("left half", "s", "left", "crown", 16, 3),
             scene::make_beam("right half", "s", "crown", "right", 16, 3)};
  s.beams[0].tangent = {{std::cos(half), std::sin(half), 0.0}};
  s.beams[1].tangent = {{1, 0, 0}};
  for (scene::Beam& b : s.beams) {
    b.curve = scene::BeamCurve::curvature;
    b.curvature = {{0, 0, -1.0 / R}};
    b.length = R * half;
    b.axis_2 = {{-b.tangent[1], b.tangent[0], 0.0}};
  }
  s.joints = {scene::make_joint("clamp", scene::JointKind::fixed, "", left, "left", Vec3::zero()),
              scene::make_joint("hinge", scene::JointKind::revolute, "", right, "right", Vec3::zero())};
  s.motions = {pushed_down("crown", depth)};
  s.sensors = {scene::make_point_sensor("crown", scene::SensorKind::position, "crown"),
               scene::make_joint_sensor("clamp", "clamp"), scene::make_joint_sensor("hinge", "hinge")};
  s.analysis.kind = scene::AnalysisKind::statics;
  s.analysis.load_steps = load_steps;
  s.analysis.tolerance = 1e-11;
  return s;
}

struct Pushed {
  double load = 0.0, sideways = 0.0;
};

/// By shooting from the clamp: unknown are its force and moment and the load.
class ArchReference {
 public:
  Pushed at(double depth) {
    const double R = arch_radius, half = arch_half, force = arch_EI / (R * R), moment = arch_EI / R;
    const RodPiece piece{R * half, arch_EA, arch_EA, arch_EI, -1.0 / R, 0.0};
    RodSection crown;
    unknowns_ = shoot(
        [&](const std::vector<double>& u) {
          const RodSection start{-R * std::sin(half), R * std::cos(half), half,
                                 u[2] * moment,       u[0] * force,       u[1] * force};
          crown = along(piece, start, 2000);
          RodSection after = crown;
          after.fy += u[3] * force;  // the part beyond carries the load as well
          const RodSection end = along(piece, after, 2000);
          return std::vector<double>{(crown.y - (R - depth)) / R, (end.x - R * std::sin(half)) / R,
                                     (end.y - R * std::cos(half)) / R, end.moment / moment};
        },
        unknowns_, 1e-11);
    return {unknowns_[3] * force, crown.x};
  }

 private:
  std::vector<double> unknowns_{0.0, 0.0, 0.0, 0.0};
};

void deep_arch(Bench& bench) {
  const int rows = 120;
  const double depth = 120.0;
  const run::MemoryRun run = bench.run(arch(depth, rows));
  ArchReference reference;
  double worst_load = 0.0, worst_place = 0.0, limit_load = 0.0;
  const std::vector<double> a = run.series("clamp.fy"), b = run.series("hinge.fy"), x = run.series("crown.x");
  std::vector<double> load;
  for (std::size_t r = 0; r < run.rows.size(); ++r) load.push_back(a[r] + b[r]);
  for (std::size_t r = 1; r < run.rows.size(); ++r) {
    const Pushed exact = reference.at(depth * run.rows[r].time);
    worst_load = std::max(worst_load, std::abs(load[r] - exact.load));
    worst_place = std::max(worst_place, std::abs(x[r] - exact.sideways));
  }
  for (std::size_t r = 1; r + 1 < load.size(); ++r)
    if (load[r] >= load[r - 1] && load[r] > load[r + 1]) {  // parabola through three rows
      const double d1 = 0.5 * (load[r + 1] - load[r - 1]), d2 = load[r + 1] - 2.0 * load[r] + load[r - 1];
      limit_load = std::max(limit_load, load[r] - 0.5 * d1 * d1 / d2);
    }
  bench.error("load along the whole path, of its largest", worst_load / 897.28913, 1e-6);
  bench.error("crown sideways, of the radius", worst_place / arch_radius, 1e-6);
  bench.error("limit load against 897.28913", std::abs(limit_load / 897.28913 - 1.0), 1e-4);
}

constexpr double frame_leg = 120.0, frame_arm = 24.0, frame_EA = 7.2e6 * 6.0, frame_GA = 5.0 / 6.0 / 2.6 * frame_EA,
                 frame_EI = 7.2e6 * 2.0;

/// Right-angle frame on two hinges (Lee, Manuel, Rossow 1968), pushed down at a fifth of its beam.
scene::Scene frame(double depth, int load_steps) {
  scene::Scene s;
  s.name = "frame";
  s.sections = {scene::make_section("s", frame_EA, frame_GA, frame_GA, frame_EI, frame_EI, frame_EI)};
  const double L = frame_leg;
  s.nodes = {scene::make_node("foot", Vec3::zero()), scene::make_node("corner", {{0, L, 0}}),
             scene::make_node("loaded", {{frame_arm, L, 0}}), scene::make_node("end", {{L, L, 0}})};
  s.beams = {scene::make_beam("column", "s", "foot", "corner", 10, 3),
             scene::make_beam("arm", "s", "corner", "loaded", 2, 3),
             scene::make_beam("rest", "s", "loaded", "end", 8, 3)};
  s.beams[0].axis_2 = {{-1, 0, 0}};
  s.joints = {scene::make_joint("foot hinge", scene::JointKind::revolute, "", Vec3::zero(), "foot", Vec3::zero()),
              scene::make_joint("end hinge", scene::JointKind::revolute, "", {{L, L, 0}}, "end", Vec3::zero())};
  s.motions = {pushed_down("loaded", depth)};
  s.sensors = {scene::make_point_sensor("loaded", scene::SensorKind::position, "loaded"),
               scene::make_joint_sensor("foot", "foot hinge"), scene::make_joint_sensor("end", "end hinge")};
  s.analysis.kind = scene::AnalysisKind::statics;
  s.analysis.load_steps = load_steps;
  s.analysis.tolerance = 1e-11;
  return s;
}

class FrameReference {
 public:
  Pushed at(double depth) {
    const double L = frame_leg, force = frame_EI / (L * L), moment = frame_EI / L;
    const auto piece = [](double length, double kink) {
      return RodPiece{length, frame_EA, frame_GA, frame_EI, 0.0, kink};
    };
    RodSection loaded;
    unknowns_ = shoot(
        [&](const std::vector<double>& u) {
          const RodSection start{0.0, 0.0, 0.5 * pi + u[2], 0.0, u[0] * force, u[1] * force};
          loaded = along(piece(frame_arm, -0.5 * pi), along(piece(L, 0.0), start, 2000), 400);
          RodSection after = loaded;
          after.fy += u[3] * force;
          const RodSection end = along(piece(L - frame_arm, 0.0), after, 1600);
          return std::vector<double>{(loaded.y - (L - depth)) / L, (end.x - L) / L, (end.y - L) / L,
                                     end.moment / moment};
        },
        unknowns_, 1e-11);
    return {unknowns_[3] * force, loaded.x};
  }

 private:
  std::vector<double> unknowns_{0.0, 0.0, 0.0, 0.0};
};

void right_angle_frame(Bench& bench) {
  const double depth = 55.0;
  const run::MemoryRun run = bench.run(frame(depth, 110));
  FrameReference reference;
  double worst_load = 0.0, worst_place = 0.0, most = 0.0;
  const std::vector<double> a = run.series("foot.fy"), b = run.series("end.fy"), x = run.series("loaded.x");
  for (std::size_t r = 1; r < run.rows.size(); ++r) {
    const Pushed exact = reference.at(depth * run.rows[r].time);
    worst_load = std::max(worst_load, std::abs(a[r] + b[r] - exact.load));
    worst_place = std::max(worst_place, std::abs(x[r] - exact.sideways));
    most = std::max(most, a[r] + b[r]);
  }
  bench.tell("largest load [N]", most);
  bench.error("load along the path past its limit, of its largest", worst_load / most, 1e-6);
  bench.error("loaded point sideways, of the leg", worst_place / frame_leg, 1e-6);
}

}  // namespace

void add_buckling(std::vector<Definition>& table) {
  table.push_back(
      {"snap_through_arch", "buckling",
       "a deep arch whose crown is driven down past the limit load: load and sideways place along the whole "
       "path to 1e-6, the limit load of 897.28913 to 1e-4",
       deep_arch});
  table.push_back({"right_angle_frame", "buckling",
                   "a right-angle frame on two hinges, driven down past its limit load: load and place to 1e-6",
                   right_angle_frame});
}

}  // namespace bough::stress
