/// One system, many ways to solve it: every gallery scene over threads, leaf sizes, depths, forms, against the
/// monolithic solver and the forms with global multipliers.
///
/// Per quantity the difference has to be at most the largest of
///   1e-9 of the quantity's maximum,
///   its round-off floor: 1e-12 of the largest component of the same sensor and kind (lengths, angles, forces,
///     moments); energies, which
///   nearly cancel in conservative scenes, 1e-12 of the largest sum of their parts' magnitudes,
///   ten times what the largest of three twins does whose initial positions, velocities, loads and gravity differ by
///     1e-15.
/// The third clause is for scenes that amplify round-off by themselves (chaos, near-singular poses, reactions that
/// are not unique).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "bough/solve/reference/monolithic.hpp"
#include "verify_scenes.hpp"

namespace bough::verify {
namespace {

/// A scene of the gallery, long ones shortened to a second or so on one thread, their hard places kept in.
scene::Scene short_gallery(const std::string& name) {
  static const std::map<std::string, double> end_times = {{"andrews_squeezer", 0.01},
                                                          {"bricard", 0.3},
                                                          {"chain", 0.05},
                                                          {"double_pendulum", 1},
                                                          {"flying_spaghetti", 0.3},
                                                          {"four_bar_misaligned", 0.4},
                                                          {"four_bar_planar", 0.9},
                                                          {"free_body", 1},
                                                          {"heavy_top", 0.05},
                                                          {"pendulum", 1},
                                                          {"right_angle_cantilever", 0.5},
                                                          {"slider_crank", 0.1},
                                                          {"spin_up", 0.5}};
  scene::Scene s = gallery(name);
  s.expected.clear();
  const auto found = end_times.find(name);
  if (s.analysis.kind == scene::AnalysisKind::dynamics)
    s.analysis.end_time =
        found != end_times.end() ? found->second : std::min(s.analysis.end_time, 100.0 * s.analysis.step_size);
  if (s.analysis
          .arc_length) {  // lengths along a path follow the iterations, which round-off may change: half the load in steps
    s.analysis.arc_length.reset();
    s.analysis.load_steps = 4;
    for (scene::PointLoad& load : s.point_loads) load.force = 0.5 * load.force;
  }
  return s;
}

/// Equal bit for bit, times and iterations included.
bool equal_bits(const Outcome& a, const Outcome& b) {
  if (a.rows.size() != b.rows.size()) return false;
  const auto same = [](double x, double y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  for (std::size_t r = 0; r < a.rows.size(); ++r) {
    if (!same(a.rows[r].time, b.rows[r].time) || a.rows[r].iterations != b.rows[r].iterations) return false;
    for (std::size_t c = 0; c < a.rows[r].values.size(); ++c)
      if (!same(a.rows[r].values[c], b.rows[r].values[c])) return false;
  }
  return true;
}

/// Largest |a - b| of each column; rows are matched by time, and a run that cut steps differently counts where the
/// times agree.
std::vector<double> differences(const Outcome& a, const Outcome& b) {
  std::vector<double> most(a.header.columns.size(), 0.0);
  std::size_t k = 0;
  for (const records::HistoryRow& row : a.rows) {
    while (k < b.rows.size() && b.rows[k].time < row.time) ++k;
    if (k == b.rows.size()) break;
    if (b.rows[k].time != row.time) continue;
    for (std::size_t c = 0; c < most.size(); ++c)
      most[c] = std::max(most[c], std::abs(row.values[c] - b.rows[k].values[c]));
  }
  return most;
}

std::vector<double> maxima(const Outcome& a) {
  std::vector<double> most(a.header.columns.size(), 0.0);
  for (const records::HistoryRow& row : a.rows)
    for (std::size_t c = 0; c < most.size(); ++c) most[c] = std::max(most[c], std::abs(row.values[c]));
  return most;
}

/// Runs to be compared iterate to round-off: what Newton leaves at a tolerance of 1e-8 is not the solver's.
scene::Scene sharp_gallery(const std::string& name) {
  scene::Scene s = short_gallery(name);
  s.analysis.tolerance = 1e-13;
  return s;
}

/// Columns of one sensor that measure the same kind of thing share a scale: the components of a vector.
std::vector<double> scales_by_kind(const Outcome& a, const std::vector<double>& most) {
  std::map<std::string, double> by_kind;
  const auto kind = [](const std::string& column) {
    const std::size_t dot = column.rfind('.');
    if (dot == std::string::npos) return column;
    const std::string component = column.substr(dot + 1);
    const bool angular =
        component[0] == 'm' || component[0] == 'M' || component[0] == 'T' || component[0] == 'w' || component[0] == 'k';
    return column.substr(0, dot) + (angular ? " angular" : " linear");
  };
  for (std::size_t c = 0; c < most.size(); ++c)
    by_kind[kind(a.header.columns[c])] = std::max(by_kind[kind(a.header.columns[c])], most[c]);
  std::vector<double> scales;
  for (const std::string& column : a.header.columns)
    scales.push_back(column == "energy" ? std::max(a.summary.checks.energy_scale, by_kind[kind(column)])
                                        : by_kind[kind(column)]);
  return scales;
}

/// The scene moved by a few units of round-off.
scene::Scene twin(scene::Scene s, double relative) {
  double sign = 1.0;
  const auto nudge = [&](Vec3<double>& v) {
    for (int i = 0; i < 3; ++i) v[i] *= 1.0 + (sign = -sign) * relative;
  };
  for (scene::Node& n : s.nodes) nudge(n.placement.pose.x);
  for (scene::Body& b : s.bodies) {
    nudge(b.placement.pose.x);
    b.mass *= 1.0 + relative;
  }
  for (scene::Section& c : s.sections)
    for (int i = 0; i < 6; ++i) c.stiffness(i, i) *= 1.0 + (sign = -sign) * relative;
  for (scene::InitialVelocity& v : s.initial_velocities) {
    nudge(v.velocity);
    nudge(v.angular_velocity);
  }
  for (scene::PointLoad& l : s.point_loads) {
    nudge(l.force);
    nudge(l.moment);
  }
  nudge(s.gravity);
  return s;
}

/// What a scene's quantities may differ by, and which clause allows it.
struct Bar {
  std::vector<double> relative, floor, twin;
  Outcome base;

  explicit Bar(const scene::Scene& s) : base(run(s)) {
    const std::vector<double> most = maxima(base), kinds = scales_by_kind(base, most);
    // Moments are sums of forces times lengths, whatever comes of them.
    const double length = plan::make_plan(s).length_scale;
    twin.assign(most.size(), 0.0);
    for (const double e : {1e-15, -1e-15, 3e-15}) {
      const std::vector<double> d = differences(base, run(verify::twin(s, e)));
      for (std::size_t c = 0; c < d.size(); ++c) twin[c] = std::max(twin[c], 10.0 * d[c]);
    }
    for (std::size_t c = 0; c < most.size(); ++c) {
      relative.push_back(1e-9 * most[c]);
      const std::string& column = base.header.columns[c];
      const bool is_moment = column.ends_with(".mx") || column.ends_with(".my") || column.ends_with(".mz");
      double forces = 0.0;
      for (std::size_t k = 0; is_moment && k < most.size(); ++k)
        if (base.header.columns[k].starts_with(column.substr(0, column.rfind('.') + 1) + "f"))
          forces = std::max(forces, most[k]);
      floor.push_back(std::max(1e-12 * kinds[c], 1e-15 * length * forces));
    }
  }

  /// 0: within 1e-9, 1: the floor was needed, 2: the twin was needed, 3: too far.
  int clause(std::size_t c, double difference) const {
    if (difference <= relative[c]) return 0;
    if (difference <= floor[c]) return 1;
    return difference <= twin[c] ? 2 : 3;
  }
};

/// Compares a variant and remembers the clause each quantity needed.
void compare(const Bar& bar, const Outcome& other, const std::string& what, std::vector<int>& needed,
             std::vector<double>& most) {
  ASSERT_TRUE(other.ok()) << what << ": " << other.text();
  EXPECT_EQ(other.rows.back().time, bar.base.rows.back().time) << what;
  const std::vector<double> d = differences(bar.base, other);
  for (std::size_t c = 0; c < d.size(); ++c) {
    const int clause = bar.clause(c, d[c]);
    needed[c] = std::max(needed[c], clause);
    most[c] = std::max(most[c], d[c]);
    EXPECT_LT(clause, 3) << what << ", " << bar.base.header.columns[c] << ": " << d[c] << " against " << bar.relative[c]
                         << " (1e-9), " << bar.floor[c] << " (floor), " << bar.twin[c] << " (twin)";
  }
}

void print_clauses(const std::string& name, const Bar& bar, const std::vector<int>& needed,
                   const std::vector<double>& most) {
  static const char* const words[] = {"1e-9", "floor", "twin", "NOT MET"};
  for (int clause = 0; clause < 4; ++clause) {
    double worst = 0.0;
    std::string columns;
    for (std::size_t c = 0; c < needed.size(); ++c) {
      if (needed[c] != clause) continue;
      columns += (columns.empty() ? "" : ", ") + bar.base.header.columns[c];
      worst = std::max(worst, bar.relative[c] > 0.0 ? 1e-9 * most[c] / bar.relative[c] : 0.0);
    }
    if (!columns.empty())
      std::printf("  %s: clause %s, worst %.1e of the maximum: %s\n", name.c_str(), words[clause], worst,
                  columns.c_str());
  }
}

class VerifySolver : public ::testing::TestWithParam<std::string> {};

TEST_P(VerifySolver, threads_change_no_bit) {
  scene::Scene s = short_gallery(GetParam());
  s.without = {"small"};  // tasks, however small the scene
  const Outcome one = run(s, 1);
  ASSERT_TRUE(one.ok()) << one.text();
  for (const int threads : {2, 3, 8}) EXPECT_TRUE(equal_bits(one, run(s, threads))) << threads << " threads";
}

TEST_P(VerifySolver, leaf_sizes_depths_and_the_monolithic_solver_agree) {
  const scene::Scene s = sharp_gallery(GetParam());
  const Bar bar(s);
  ASSERT_TRUE(bar.base.ok()) << bar.base.text();
  std::vector<int> needed(bar.base.header.columns.size(), 0);
  std::vector<double> most(needed.size(), 0.0);
  for (const int leaf : {1, 2, 5, 17, 1000000}) {
    scene::Scene v = s;
    v.solver.leaf_size = leaf;
    compare(bar, run(v), "leaf size " + std::to_string(leaf), needed, most);
  }
  for (int depth = 0; depth <= 6; ++depth) {
    scene::Scene v = s;
    v.solver.depth = depth;
    compare(bar, run(v), "depth " + std::to_string(depth), needed, most);
  }
  if (solve::Monolithic::available()) {
    scene::Scene v = s;
    v.solver.form = scene::SolverForm::monolithic;
    compare(bar, run(v), "monolithic", needed, most);
  }
  print_clauses(GetParam(), bar, needed, most);
}

/// Sub-domains small enough that several are torn apart in most scenes.
TEST_P(VerifySolver, all_forms_agree) {
  scene::Scene s = sharp_gallery(GetParam());
  s.solver.leaf_size = 4;
  const Bar bar(s);
  ASSERT_TRUE(bar.base.ok()) << bar.base.text();
  std::vector<int> needed(bar.base.header.columns.size(), 0);
  std::vector<double> most(needed.size(), 0.0);
  for (const auto& [form, what] :
       {std::pair{scene::SolverForm::augmented, "augmented"}, std::pair{scene::SolverForm::global, "global"},
        std::pair{scene::SolverForm::hybrid, "hybrid"}}) {
    scene::Scene v = s;
    v.solver.form = form;
    compare(bar, run(v), what, needed, most);
  }
  for (const double factor : {1e-3, 10.0}) {
    scene::Scene v = s;
    v.solver.form = scene::SolverForm::augmented;
    v.solver.penalty_factor = factor;
    compare(bar, run(v), factor < 1.0 ? "augmented, a small penalty" : "augmented, a large penalty", needed, most);
  }
  print_clauses(GetParam(), bar, needed, most);
}

INSTANTIATE_TEST_SUITE_P(Gallery, VerifySolver, ::testing::ValuesIn(gallery_names()),
                         [](const ::testing::TestParamInfo<std::string>& scene) { return scene.param; });

}  // namespace
}  // namespace bough::verify
