// Two scenes built as structs, simulated with the core library, and compared with their closed forms.
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "bough/run/outlook.hpp"
#include "bough/run/simulate.hpp"
#include "bough/scene/problems.hpp"
#include "bough/scene/scene.hpp"

namespace {

using namespace bough;

struct KeepLastRow : records::Recorder {
  std::vector<double> values;
  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow& row) override { values = row.values; }
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override {}
};

// A point mass on a massless bar of 1 m, released from the horizontal: position after 1 s by Jacobi's elliptic
// functions.
scene::Scene make_pendulum() {
  scene::Scene s;
  s.name = "pendulum";
  s.gravity = {{0.0, -9.81, 0.0}};
  scene::Body bob;
  bob.name = "bob";
  bob.mass = 1.0;
  bob.is_point_mass = true;
  bob.placement.pose.x = {{-1.0, 0.0, 0.0}};
  s.bodies.push_back(bob);
  scene::Joint hinge;
  hinge.name = "hinge";
  hinge.kind = scene::JointKind::revolute;
  hinge.second.to = "bob";
  hinge.second.offset.x = {{1.0, 0.0, 0.0}};
  s.joints.push_back(hinge);
  s.analysis.end_time = 1.0;
  s.analysis.step_size = 2e-3;
  s.analysis.spectral_radius = 0.9;
  return s;
}

// A cantilever of 1 m bent by a moment (pi/2) EI / L to a quarter of a circle of radius 2 L / pi: constant strain, so
// any number of elements is exact. 64 elements in leaves of 8: the tree is cut, by the library's own dissection.
scene::Scene make_quarter_circle() {
  constexpr double stiffness = 100.0;
  scene::Scene s;
  s.name = "quarter_circle";
  scene::Section section;
  section.name = "bar";
  section.stiffness = section.mass = section.damping = motion::Mat6<double>::zero();
  for (int i = 0; i < 6; ++i) section.stiffness(i, i) = i < 3 ? 1e6 : stiffness;
  s.sections.push_back(section);
  scene::Node root, tip;
  root.name = "root";
  tip.name = "tip";
  tip.placement.pose.x = {{1.0, 0.0, 0.0}};
  s.nodes = {root, tip};
  scene::Beam beam;
  beam.name = "bar";
  beam.section = "bar";
  beam.start = "root";
  beam.end = "tip";
  beam.elements = 64;
  s.beams.push_back(beam);
  scene::Joint wall;
  wall.name = "wall";
  wall.second.to = "root";
  s.joints.push_back(wall);
  scene::PointLoad load;
  load.name = "bend";
  load.at.to = "tip";
  load.axes = scene::LoadAxes::body;
  load.moment = {{0.0, 0.0, 0.5 * std::numbers::pi * stiffness}};
  s.point_loads.push_back(load);
  s.analysis.kind = scene::AnalysisKind::statics;
  s.analysis.load_steps = 4;
  s.solver.leaf_size = 8;
  return s;
}

bool meets(scene::Scene scene, const char* sensed, double x, double y, double tolerance) {
  scene::Sensor sensor;
  sensor.name = "position";
  sensor.at.to = sensed;
  scene.sensors.push_back(sensor);
  for (const scene::SceneProblem& problem : scene::problems_in(scene))
    std::printf("%s: %s %s\n", scene.name.c_str(), problem.section.c_str(), problem.rule.c_str());
  KeepLastRow recorder;
  const records::Summary summary = run::simulate(scene, {.threads = 2}, recorder);
  if (summary.status != records::RunStatus::ok || recorder.values.size() < 2) {
    std::printf("%s: %s\n", scene.name.c_str(), summary.cause.c_str());
    return false;
  }
  const double error = std::hypot(recorder.values[0] - x, recorder.values[1] - y);
  std::printf("%s: (%.12f, %.12f), error %.1e\n", scene.name.c_str(), recorder.values[0], recorder.values[1], error);
  return error <= tolerance;
}

// The pendulum swings in a plane: one node of three unknowns and the two rows of its hinge that are left, of 6 + 5 in
// space.
bool is_planned_in_a_plane() {
  const run::Outlook outlook = run::look_ahead(make_pendulum());
  std::printf("pendulum: motion %s, %d unknowns of %d\n", outlook.motions.c_str(),
              static_cast<int>(outlook.effort.unknowns), static_cast<int>(outlook.unknowns_in_space));
  return outlook.motions == "in a plane" && outlook.effort.unknowns == 5;
}

}  // namespace

int main() {
  // Order 2 with a step of 2 ms: about 1e-4 at the end of 1 s.
  const bool swings = meets(make_pendulum(), "bob", 0.986291751131875, -0.165010853125541, 1e-3);
  const bool bends = meets(make_quarter_circle(), "tip", 2.0 / std::numbers::pi, 2.0 / std::numbers::pi, 1e-8);
  return is_planned_in_a_plane() && swings && bends ? 0 : 1;
}
