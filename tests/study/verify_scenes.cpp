#include "verify_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "bough/io/read_scene.hpp"
#include "bough/scene/problems.hpp"
#include "bough/schedule/serial.hpp"
#include "bough/study/simulate.hpp"
#include "support/source_dir.hpp"

namespace bough::verify {

namespace {

struct Memory final : results::Recorder {
  Outcome& out;
  explicit Memory(Outcome& o) : out(o) {}
  void begin(const results::HistoryHeader& header) override { out.header = header; }
  void row(const results::HistoryRow& row) override { out.rows.push_back(row); }
  void motion(const results::MotionFrame&) override {}
  void end(const results::Summary& summary) override { out.summary = summary; }
};

}  // namespace

std::size_t Outcome::column(std::string_view name) const {
  const auto found = std::find(header.columns.begin(), header.columns.end(), name);
  if (found == header.columns.end()) throw std::out_of_range("no column " + std::string(name));
  return static_cast<std::size_t>(found - header.columns.begin());
}

std::vector<double> Outcome::series(std::string_view name) const {
  const std::size_t c = column(name);
  std::vector<double> values;
  for (const results::HistoryRow& row : rows) values.push_back(row.values[c]);
  return values;
}

bool Outcome::says(std::string_view text) const {
  const auto holds = [text](const std::string& s) { return s.find(text) != std::string::npos; };
  return holds(summary.cause) || std::any_of(summary.notes.begin(), summary.notes.end(), holds);
}

std::string Outcome::text() const {
  std::string all = "cause: " + summary.cause;
  for (const std::string& n : summary.notes) all += "\nnote: " + n;
  return all;
}

std::string problems_of(const scene::Scene& scene) {
  std::string refused;
  for (const scene::SceneProblem& p : scene::problems_in(scene))
    if (!p.is_warning)
      refused += " " + p.section + " " + std::to_string(p.index) + " " + p.key + " '" + p.value + "': " + p.rule;
  return refused;
}

Outcome run(const scene::Scene& scene, int threads) {
  Outcome out;
  const std::string refused = problems_of(scene);
  if (!refused.empty()) {
    out.summary.cause = "refused:" + refused;
    return out;
  }
  Memory memory(out);
  study::SimulateOptions options;
  options.threads = threads;
  study::simulate(scene, options, memory);
  return out;
}

scene::Scene gallery(const std::string& name, const std::vector<std::string>& overrides) {
  const auto file = support::source_dir() / "data" / "scenarios" / (name + ".json");
  const io::SceneFile read = io::read_scene(file, overrides);
  if (!read.ok()) throw std::runtime_error(name + ": " + read.problems.front().text());
  return read.scene;
}

std::vector<std::string> gallery_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(support::source_dir() / "data" / "scenarios"))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

scene::Section make_section(const std::string& name, double EA, double GA2, double GA3, double GJ, double EI2,
                            double EI3) {
  scene::Section s;
  s.name = name;
  s.stiffness = s.mass = s.damping = scene::Mat6::zero();
  const double diagonal[6] = {EA, GA2, GA3, GJ, EI2, EI3};
  for (int i = 0; i < 6; ++i) s.stiffness(i, i) = diagonal[i];
  return s;
}

void set_mass(scene::Section& s, double mass, double rotary_1, double rotary_2, double rotary_3) {
  const double diagonal[6] = {mass, mass, mass, rotary_1, rotary_2, rotary_3};
  for (int i = 0; i < 6; ++i) s.mass(i, i) = diagonal[i];
}

scene::Node make_node(const std::string& name, const Vec3<double>& position) {
  scene::Node n;
  n.name = name;
  n.placement.pose.x = position;
  return n;
}

scene::Beam make_beam(const std::string& name, const std::string& section, const std::string& start,
                      const std::string& end, int elements, int order) {
  scene::Beam b;
  b.name = name;
  b.section = section;
  b.start = start;
  b.end = end;
  b.axis_2 = Vec3<double>::unit(1);
  b.elements = elements;
  b.order = order;
  return b;
}

scene::Joint make_weld(const std::string& name, const std::string& node) {
  scene::Joint j;
  j.name = name;
  j.kind = scene::JointKind::fixed;
  j.second.to = node;
  return j;
}

scene::PointLoad make_load(const std::string& node, const Vec3<double>& force, const Vec3<double>& moment,
                           scene::LoadAxes axes) {
  scene::PointLoad l;
  l.name = "load at " + node;
  l.at.to = node;
  l.axes = axes;
  l.force = force;
  l.moment = moment;
  return l;
}

scene::Sensor make_point_sensor(const std::string& name, scene::SensorKind kind, const std::string& node) {
  scene::Sensor s;
  s.name = name;
  s.kind = kind;
  s.at.to = node;
  return s;
}

scene::Sensor make_section_sensor(const std::string& name, const std::string& beam, double station) {
  scene::Sensor s;
  s.name = name;
  s.kind = scene::SensorKind::section_force;
  s.beam = beam;
  s.station = station;
  return s;
}

scene::Sensor make_joint_sensor(const std::string& name, const std::string& joint, scene::SensorKind kind) {
  scene::Sensor s;
  s.name = name;
  s.kind = kind;
  s.joint = joint;
  return s;
}

scene::Scene make_cantilever(const scene::Section& section, double length, int elements, int order) {
  scene::Scene s;
  s.name = "cantilever";
  s.sections = {section};
  s.nodes = {make_node("root", Vec3<double>::zero()), make_node("tip", length * Vec3<double>::unit(0))};
  s.beams = {make_beam("beam", section.name, "root", "tip", elements, order)};
  s.joints = {make_weld("clamp", "root")};
  s.sensors = {make_point_sensor("tip", scene::SensorKind::position, "tip"),
               make_point_sensor("turn", scene::SensorKind::rotation, "tip"), make_joint_sensor("clamp", "clamp")};
  s.analysis.kind = scene::AnalysisKind::statics;
  return s;
}

Direct::Direct(const scene::Scene& scene)
    : plan(plan::make_plan(scene)),
      system(plan, scene.solver, schedule::make_serial_walker()),
      state(step::make_initial_state(plan)),
      options(step::make_step_options(scene.analysis)) {
  const std::string refused = problems_of(scene);
  if (!refused.empty()) throw std::invalid_argument("refused:" + refused);
}

Vec3<double> Direct::position(const std::string& node) const {
  for (std::size_t i = 0; i < plan.nodes.size(); ++i)
    if (plan.nodes[i].name == node) return state.nodes[i].x.hi + state.nodes[i].x.lo;
  throw std::out_of_range(node);
}

double observed_order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace bough::verify
