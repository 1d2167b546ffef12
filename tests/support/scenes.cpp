#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "bough/io/read_scene.hpp"
#include "support/given.hpp"
#include "support/source_dir.hpp"

namespace bough::support {

namespace {

scene::Scene checked(io::SceneFile file) {
  if (file.ok()) return std::move(file.scene);
  std::string all = "scene '" + file.scene.name + "':";
  for (const io::Problem& p : file.problems) all += "\n  " + p.text();
  throw std::runtime_error(all);
}

class Memory final : public records::Recorder {
 public:
  explicit Memory(Table& table) : table_(table) {}
  void begin(const records::HistoryHeader& header) override { table_.columns = header.columns; }
  void row(const records::HistoryRow& row) override {
    table_.times.push_back(row.time);
    table_.step_sizes.push_back(row.step_size);
    table_.rows.push_back(row.values);
  }
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override {}

 private:
  Table& table_;
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> parts;
  std::stringstream in(!line.empty() && line.back() == '\r' ? line.substr(0, line.size() - 1) : line);
  for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
  return parts;
}

}  // namespace

scene::Scene gallery(const std::string& stem, const std::vector<std::string>& overrides) {
  return checked(io::read_scene((source_dir() / "data" / "scenarios" / (stem + ".json")).string(), overrides));
}

scene::Scene scene_of(const std::string& json, const std::vector<std::string>& overrides) {
  const std::size_t brace = json.find('{');
  return checked(io::read_scene_text("{\"schema_version\": 1, " + json.substr(brace + 1), "test", overrides));
}

scene::Sensor point_sensor(const std::string& name, scene::SensorKind kind, const scene::Attachment& at,
                           scene::LoadAxes axes) {
  scene::Sensor s;
  s.name = name;
  s.kind = kind;
  s.at = at;
  s.axes = axes;
  return s;
}

scene::Sensor joint_sensor(const std::string& name, scene::SensorKind kind, const std::string& joint) {
  scene::Sensor s;
  s.name = name;
  s.kind = kind;
  s.joint = joint;
  return s;
}

std::string text(double value) {
  char buffer[40];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::size_t Table::column(const std::string& name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end()) throw std::runtime_error("no column '" + name + "'");
  return static_cast<std::size_t>(found - columns.begin());
}

std::vector<double> Table::of(const std::string& name) const {
  const std::size_t c = column(name);
  std::vector<double> values;
  for (const std::vector<double>& row : rows) values.push_back(row[c]);
  return values;
}

std::size_t Table::row_at(double time) const {
  const auto next = std::lower_bound(times.begin(), times.end(), time - 1e-9);
  if (next == times.end() || *next > time + 1e-9) throw std::runtime_error("no row at " + text(time));
  return static_cast<std::size_t>(next - times.begin());
}

double Table::largest(const std::string& name) const {
  double most = 0.0;
  for (double v : of(name)) most = std::max(most, std::abs(v));
  return most;
}

Table reference(const std::string& file) {
  std::ifstream in(source_dir() / "data" / "reference" / file);
  if (!in) throw std::runtime_error("cannot read " + file);
  Table table;
  std::string line;
  std::getline(in, line);
  table.columns = split(line);
  table.columns.erase(table.columns.begin());
  while (std::getline(in, line)) {
    std::vector<double> values;
    for (const std::string& part : split(line)) values.push_back(std::strtod(part.c_str(), nullptr));
    table.times.push_back(values.front());
    table.rows.emplace_back(values.begin() + 1, values.end());
  }
  return table;
}

scene::Scene moved(scene::Scene s, const scene::Frame& to) {
  if (!s.frames.empty() || !s.motions.empty())
    throw std::runtime_error("moved: frames and prescribed motions are not handled");
  const auto place = [&to](scene::Placement& p) { p.pose = motion::compose(to, p.pose); };
  const auto attach = [&to](scene::Attachment& a) {
    if (a.to.empty() || a.to == "ground") a.offset = motion::compose(to, a.offset);
  };
  const auto turn = [&to](scene::Vec3& v) { v = to.R * v; };
  turn(s.gravity);
  for (scene::Node& n : s.nodes) place(n.placement);
  for (scene::Body& b : s.bodies) place(b.placement);
  for (scene::Beam& b : s.beams) {
    turn(b.axis_2);
    turn(b.tangent);
  }
  for (scene::Joint& j : s.joints) {
    attach(j.first);
    attach(j.second);
  }
  for (scene::Coupling& c : s.couplings) {
    attach(c.first);
    attach(c.second);
    for (const scene::CouplingField& field : c.kind->fields)
      if (field.type == scene::CouplingFieldType::direction || field.type == scene::CouplingFieldType::axis) {
        const auto values = values_of(c, field.name);
        scene::Vec3 direction{{values[0], values[1], values[2]}};
        turn(direction);
        std::copy_n(direction.v, 3, values.begin());
      }
  }
  const auto turn_load = [&turn](auto& load) {
    if (load.axes != scene::LoadAxes::space) return;
    turn(load.force);
    turn(load.moment);
  };
  for (scene::PointLoad& l : s.point_loads) turn_load(l);
  for (scene::LineLoad& l : s.line_loads) turn_load(l);
  for (scene::InitialVelocity& v : s.initial_velocities) {
    if (v.axes != scene::LoadAxes::space) continue;
    turn(v.velocity);
    turn(v.angular_velocity);
  }
  return s;
}

void expect_sound_solutions(double backward_error, double unknowns) {
  constexpr double unit_round_off = 0x1p-53;
  // |b| <= |A| |x| + |r|, so |r| / (|A| |x|) is at most 2 eta / (1 - eta).
  EXPECT_LE(2.0 * backward_error / (1.0 - backward_error) / (std::max(1.0, unknowns) * unit_round_off), 30.0)
      << "LAPACK's ratio of a linear solution, backward error " << backward_error;
}

Outcome run(const scene::Scene& scene, const run::ProgressCallback& progress) {
  Outcome outcome;
  Memory memory(outcome.history);
  outcome.summary = run::simulate(scene, {}, memory, progress);
  // The external solvers serve as oracles; their pivoting does not suit dependent rows.
  if (outcome.ok() && scene.solver.form != scene::SolverForm::monolithic)
    for (const auto& [name, value] : outcome.summary.solver)
      if (name == "unknowns") expect_sound_solutions(outcome.summary.checks.linear_backward_error_max, value);
  return outcome;
}

double order_of(double coarse_error, double fine_error, double ratio) {
  return std::log(coarse_error / fine_error) / std::log(ratio);
}

double largest_difference(const Table& a, const std::string& column_a, const Table& reference,
                          const std::string& column_b) {
  const std::size_t ca = a.column(column_a), cb = reference.column(column_b);
  double most = 0.0;
  int met = 0;
  for (std::size_t r = 0; r < reference.times.size(); ++r) {
    const double t = reference.times[r];
    const auto next = std::lower_bound(a.times.begin(), a.times.end(), t - 1e-9);
    if (next == a.times.end() || *next > t + 1e-9) continue;
    most =
        std::max(most, std::abs(a.rows[static_cast<std::size_t>(next - a.times.begin())][ca] - reference.rows[r][cb]));
    ++met;
  }
  if (met == 0) throw std::runtime_error("the tables have no time in common");
  return most;
}

Outcome run_ok(const scene::Scene& scene) {
  Outcome r = run(scene);
  EXPECT_TRUE(r.ok()) << r.summary.cause;
  return r;
}

}  // namespace bough::support
