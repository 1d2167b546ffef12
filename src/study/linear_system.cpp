#include "bough/study/linear_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bough/blocks/at.hpp"
#include "bough/io/number_text.hpp"
#include "bough/records/no_recorder.hpp"
#include "bough/results/interface_force.hpp"
#include "bough/run/simulate.hpp"
#include "bough/scene/joint_kinds.hpp"
#include "bough/scene/sensor_kinds.hpp"

namespace bough::study {

namespace {

/// One entry of a column: its own contributions and those of its mirror.
struct Entry {
  int row;
  double value, mirror;
};

/// Columns of the sum of the element matrices; rows ascending, contributions in the order of the elements.
std::vector<std::vector<Entry>> gather_columns(step::System& system) {
  std::vector<std::vector<Entry>> columns(system.places().size());
  std::vector<std::int64_t> place;
  for (int e = 0; e < system.plan().graph.num_elements(); ++e) {
    const solve::ConstElementView a = system.elements().matrix_of(e, place);
    const auto n = static_cast<std::int64_t>(place.size());
    for (std::int64_t i = 0; i < n; ++i)
      for (std::int64_t j = 0; j < n; ++j) {
        if (place[at(i)] < 0 || place[at(j)] < 0) continue;
        columns[at(place[at(j)])].push_back({static_cast<int>(place[at(i)]), a[i * n + j], 0.0});
        columns[at(place[at(i)])].push_back({static_cast<int>(place[at(j)]), 0.0, a[i * n + j]});
      }
  }
  for (std::vector<Entry>& list : columns) {
    std::stable_sort(list.begin(), list.end(), [](const Entry& a, const Entry& b) { return a.row < b.row; });
    std::size_t count = 0;
    for (const Entry& e : list) {
      if (count > 0 && list[count - 1].row == e.row) {
        list[count - 1].value += e.value;
        list[count - 1].mirror += e.mirror;
      } else {
        list[count++] = e;
      }
    }
    list.resize(count);
  }
  return columns;
}

bool is_symmetric(const std::vector<std::vector<Entry>>& columns) {
  std::vector<double> largest(columns.size(), 0.0);
  for (const auto& list : columns)
    for (const Entry& e : list) largest[at(e.row)] = std::max(largest[at(e.row)], std::abs(e.value));
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (const Entry& e : columns[j])
      if (std::abs(e.value - e.mirror) > 1e-14 * std::max(largest[at(e.row)], largest[j])) return false;
  return true;
}

io::SparseMatrix make_matrix(step::System& system) {
  const std::vector<std::vector<Entry>> columns = gather_columns(system);
  io::SparseMatrix m;
  m.size = static_cast<int>(columns.size());
  m.is_symmetric = is_symmetric(columns);
  m.column_begin.assign(1, 0);
  for (std::size_t j = 0; j < columns.size(); ++j) {
    for (const Entry& e : columns[j]) {
      const double value = m.is_symmetric ? 0.5 * (e.value + e.mirror) : e.value;
      if (value == 0.0 || (m.is_symmetric && at(e.row) < j)) continue;
      m.row.push_back(e.row);
      m.value.push_back(value);
    }
    m.column_begin.push_back(m.row.size());
  }
  return m;
}

std::string row_text(const elements::ConstraintRow& row) {
  return scene::with_axes(motion::traits_of(row.kind).about, row);
}

const char* node_text(const plan::NodeUnknowns& unknowns, std::size_t node) {
  const bool is_plane = unknowns.motions == plan::Motions::planar;
  if (unknowns.is_point_at(node))
    return is_plane ? "displacement along the plane's axes [m]" : "displacement along 1, 2, 3 [m], own axes";
  switch (unknowns.motions) {
    case plan::Motions::planar:
      return "displacement along the plane's axes [m], rotation about its normal [rad], turning with the node";
    case plan::Motions::translation:
      return "displacement along three axes [m]";
    case plan::Motions::line:
      return "displacement along the line [m]";
    case plan::Motions::spatial:
      break;
  }
  return "displacement along 1, 2, 3 [m], rotation about 1, 2, 3 [rad], own axes";
}

std::vector<UnknownBlock> make_blocks(const step::System& system) {
  const plan::Plan& plan = system.plan();
  std::vector<UnknownBlock> out;
  for (int b = 0; b < system.places().num_blocks(); ++b) {
    UnknownBlock block{system.linear().owners().name(b), "", static_cast<int>(system.places().block_begin(b)),
                       system.places().block_size(b)};
    const int joint = system.linear().owners().joint(b);
    if (system.linear().owners().signal(b) >= 0) {
      block.components = "value";
    } else if (joint < 0) {
      block.components = node_text(plan.unknowns, at(system.linear().owners().node(b)));
    } else {
      const plan::ElementPlace place = plan.directory[at(plan.joints[at(joint)].element)];
      const auto& element = plan::array_of<elements::Joint>(plan.elements)[at(place.index)];
      block.components = "multipliers";
      const std::vector<int>& rows = plan.joints[at(joint)].rows;
      for (std::size_t k = 0; k < rows.size(); ++k)
        block.components += (k == 0 ? ": " : "; ") + row_text(element.rows[rows[k]]);
    }
    out.push_back(block);
  }
  return out;
}

/// The interface of the sub-domain of this path, in the scene's units, by scaled ones: K = R^-1 K' C^-1. What is wrong
/// with the path, in words; empty: nothing is.
std::string fill_interface(step::System& system, const std::string& path, LinearSystem& out) {
  solve::AnySolver& solver = system.linear().solver();
  if (solver.column_scale().empty())
    return "the form of the solver has no interfaces of sub-domains: set /solver/form=local or augmented";
  const tree::Tree& tree = system.linear().tree();
  const std::optional<std::vector<int>> children = scene::read_path(path);
  const tree::SubdomainId id = children ? results::subdomain_at(tree, *children) : tree::none;
  if (id == tree::none || id == tree.root())
    return "the tree of the solver has no sub-domain \"" + path + "\" below its root, of " +
           std::to_string(tree.num_subdomains()) +
           ": bough profile lists them; /solver/depth and /solver/leaf_size cut it";
  constexpr int any_width = std::numeric_limits<int>::max();
  const std::vector<solve::InterfaceReport> all = solver.interfaces(system.walker(), any_width, true);
  const std::span<const double> rows = solver.row_scale(), columns = solver.column_scale();
  const solve::InterfaceReport& report = all[at(id)];
  const std::vector<std::int64_t>& unknowns = report.matrices.unknowns;
  const std::size_t n = unknowns.size();
  InterfaceSystem& to = out.interface.emplace();
  to.condition = report.condition;
  to.stiffness.resize(n * n);
  to.penalty.assign(n * n, 0.0);
  to.flexibility.resize(n * n);
  for (std::size_t j = 0; j < n; ++j) {
    const int block = tree.block_of_unknown(unknowns[j]);
    to.unknowns.push_back(system.linear().owners().name(block) + " " +
                          std::to_string(unknowns[j] - tree.unknown_begin[at(block)] + 1));
    to.penalty[j * n + j] = report.matrices.penalty[j] / rows[at(unknowns[j])] / columns[at(unknowns[j])];
    for (std::size_t i = 0; i < n; ++i) {
      to.stiffness[j * n + i] = report.matrices.stiffness[j * n + i] / rows[at(unknowns[i])] / columns[at(unknowns[j])];
      to.flexibility[j * n + i] =
          report.matrices.flexibility[j * n + i] * columns[at(unknowns[i])] * rows[at(unknowns[j])];
    }
  }
  return "";
}

/// Fills in the system from the state that a step starts from.
void fill(step::System& system, step::State state, const run::BeforeStep& attempt, const std::string& interface,
          LinearSystem& out) {
  out.is_dynamic = system.plan().is_dynamic;
  out.step = attempt.number;
  out.begin = state.time;
  out.end = attempt.end;
  out.blocks = make_blocks(system);
  elements::Slopes slopes;
  std::optional<step::Trouble> trouble;
  if (out.is_dynamic) {
    trouble = step::predict(system, state, attempt.options, attempt.end, slopes);
  } else {
    trouble = system.set_time(attempt.end);
    step::set_at_rest(state);
  }
  if (!trouble) trouble = system.evaluate(state, slopes, true);
  if (trouble) {
    out.trouble = trouble->text;
    return;
  }
  out.rhs = system.right_hand_side();
  out.matrix = make_matrix(system);
  out.solution.resize(out.rhs.size());
  trouble = system.linear().factor(true, slopes);
  if (!trouble && !interface.empty())
    if (const std::string wrong = fill_interface(system, interface, out); !wrong.empty())
      trouble = step::Trouble{wrong};
  if (!trouble) trouble = system.linear().solve(out.rhs.data(), out.solution.data());
  out.backward_error = system.linear().last_solution().backward_error;
  if (trouble) {
    out.trouble = trouble->text;
    out.solution.clear();
  }
}

bool all_finite(const std::vector<double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

std::optional<LinearSystem> make_linear_system(const scene::Scene& scene, const StepChoice& choice, int threads,
                                               std::string& cause, const std::string& interface) {
  std::optional<LinearSystem> out;
  run::SimulateOptions options;
  options.threads = threads;
  options.before_step = [&](step::System& system, const step::State& state, const run::BeforeStep& attempt) {
    const double tolerance = 1e-9 * (attempt.end - state.time);
    const bool is_it =
        choice.time ? attempt.end >= *choice.time - tolerance : attempt.number == choice.number.value_or(1);
    if (!is_it) return true;
    fill(system, state, attempt, interface, out.emplace());
    return false;
  };
  records::NoRecorder recorder;
  scene::Scene alone = scene;
  alone.analysis.errors = {};
  const records::Summary summary = run::simulate(alone, options, recorder);
  if (!out)
    cause = summary.status == records::RunStatus::failed
                ? summary.cause
                : "there is no such step: the run ends with step " + std::to_string(summary.steps.accepted);
  if (out && !out->trouble.empty() && (out->matrix.size == 0 || (!interface.empty() && !out->interface))) {
    cause = out->trouble;
    out.reset();
  }
  if (out && !(all_finite(out->matrix.value) && all_finite(out->rhs))) {
    cause = "the linear system of step " + std::to_string(out->step) + " has entries that are not finite";
    out.reset();
  }
  return out;
}

std::vector<std::string> InterfaceSystem::comments(const std::string& matrix, long step) const {
  const std::string meaning = matrix == "S"   ? "S: the sub-domain condensed to its interface"
                              : matrix == "P" ? "P: the penalty of the augmented Lagrangian, diagonal"
                                              : "F = (S + P)^-1: the interface flexibility";
  std::vector<std::string> lines{
      "bough: interface of a sub-domain in the first Newton iteration of step " + std::to_string(step) + "; " + meaning,
      "SI units; by owner and number of the component of its increment:"};
  for (std::size_t k = 0; k < unknowns.size(); ++k) lines.push_back(std::to_string(k + 1) + " " + unknowns[k]);
  return lines;
}

std::vector<std::string> LinearSystem::comments(const std::string& scene_name) const {
  std::vector<std::string> lines;
  const std::string what = is_dynamic ? "time" : "load factor";
  lines.push_back("bough: tangent of the first Newton iteration of step " + std::to_string(step) + " of '" +
                  scene_name + "', from " + what + " " + io::rounded_text(begin, 12) + " to " +
                  io::rounded_text(end, 12));
  lines.push_back(
      "A x = b, b minus the residual; SI units; x: increments of nodes (H <- H exp(eta)), then multipliers");
  if (matrix.is_symmetric) lines.push_back("symmetric within round-off: the means of the entries and their mirrors");
  for (const UnknownBlock& b : blocks)
    lines.push_back(std::to_string(b.first + 1) + "-" + std::to_string(b.first + b.count) + " " + b.owner + " " +
                    b.components);
  return lines;
}

}  // namespace bough::study
