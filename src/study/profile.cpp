#include "bough/study/profile.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include "bough/blocks/at.hpp"
#include "bough/results/interface_force.hpp"
#include "bough/scene/components.hpp"
#include "bough/schedule/serial.hpp"
#include "bough/schedule/threads.hpp"
#include "profile_cost.hpp"
#include "profile_parts.hpp"
#include "profile_run.hpp"
#include "profile_schedule.hpp"
#include "read_rate.hpp"

namespace bough::study {

namespace {

using schedule::TreeTimes;
using schedule::WalkTimes;
using tree::Stage;
using tree::Work;

constexpr std::size_t of(Work w) { return static_cast<std::size_t>(w); }
constexpr std::size_t of(Stage s) { return static_cast<std::size_t>(s); }
constexpr Work walks[] = {Work::factor, Work::forward, Work::backward, Work::residual};

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Median of each of n columns.
std::vector<double> medians(const std::vector<float>& samples, std::size_t n) {
  std::vector<double> result(n, 0.0), column;
  if (n == 0) return result;
  for (std::size_t v = 0; v < n && samples.size() >= n; ++v) {
    column.clear();
    for (std::size_t k = v; k < samples.size(); k += n) column.push_back(static_cast<double>(samples[k]));
    result[v] = median(column);
  }
  return result;
}

/// Medians of one run by visit.
struct VisitMedians {
  std::array<std::vector<double>, schedule::num_works> seconds;
  std::array<std::vector<double>, schedule::num_stages> stage;  ///< of factorizations
  std::vector<double> shared, parts;                            ///< of factorizations: see VisitTimes
  std::vector<double> wait;
  std::vector<double> evaluate;  ///< in walks that condense right-hand sides, or else in factorizations
  std::vector<double> move;      ///< of nodes, in back-substitutions
  /// Seconds of a visit in one walk of each kind, without elements and nodes.
  double solver(std::size_t visit) const;
};

double VisitMedians::solver(std::size_t v) const {
  double sum = -stage[of(Stage::evaluate)][v] - move[v];
  for (const Work w : walks) sum += seconds[of(w)][v];
  return std::max(0.0, sum - (seconds[of(Work::forward)][v] > 0.0 ? evaluate[v] : 0.0));
}

VisitMedians find_medians(const WalkTimes& times, std::size_t n) {
  VisitMedians m;
  for (auto& s : m.seconds) s.assign(n, 0.0);
  for (auto& s : m.stage) s.assign(n, 0.0);
  m.shared.assign(n, 0.0);
  m.parts.assign(n, 1.0);
  m.wait.assign(n, 0.0);
  m.evaluate.assign(n, 0.0);
  m.move.assign(n, 0.0);
  if (const TreeTimes* t = walked_tree(times, n); t != nullptr) {
    for (Work w : walks) m.seconds[of(w)] = medians(t->work[of(w)].visit, n);
    for (std::size_t k = 0; k < m.stage.size(); ++k) m.stage[k] = medians(t->work[of(Work::factor)].stage[k], n);
    m.wait = medians(t->work[of(Work::factor)].wait, n);
    if (!t->work[of(Work::factor)].shared.empty()) {
      m.shared = medians(t->work[of(Work::factor)].shared, n);
      m.parts = medians(t->work[of(Work::factor)].parts, n);
      for (std::size_t v = 0; v < n; ++v) m.shared[v] = std::min(m.shared[v], m.seconds[of(Work::factor)][v]);
    }
    const schedule::WorkTimes& up = t->work[of(Work::forward)];
    m.evaluate = up.walks > 0 ? medians(up.stage[of(Stage::evaluate)], n) : m.stage[of(Stage::evaluate)];
    if (t->work[of(Work::backward)].walks > 0) {
      const std::vector<double> substitute = medians(t->work[of(Work::backward)].stage[of(Stage::substitute)], n);
      for (std::size_t v = 0; v < n; ++v) m.move[v] = std::max(0.0, m.seconds[of(Work::backward)][v] - substitute[v]);
    }
  }
  return m;
}

/// Results of examining the system after the run.
struct Found {
  tree::Tree tree;
  solve::VisitShapes shapes;
  std::vector<solve::InterfaceReport> interfaces;
  std::vector<std::vector<records::InterfaceNode>> interface_nodes;  ///< by sub-domain; empty where the run failed
  solve::SolverCounters counters;
  blocks::BlockGraph graph;
  solve::SolveOptions options;
};

/// By sub-domain; the root has none. Places are those at the start.
std::vector<std::vector<records::InterfaceNode>> eval_interface_nodes(const step::System& system,
                                                                      const step::State& state) {
  const elements::Field field = system.instant().field(state);
  const tree::Tree& tree = system.linear().tree();
  std::vector<std::vector<records::InterfaceNode>> nodes(tree.subdomains.size());
  for (tree::SubdomainId s = 0; s < tree.num_subdomains(); ++s) {
    if (s == tree.root()) continue;
    for (const results::InterfaceForce& f : results::eval_interface_forces(system, state, field, s)) {
      const plan::NodePlan& node = system.plan().nodes[at(f.node)];
      records::InterfaceNode& to = nodes[at(s)].emplace_back();
      to.name = node.name;
      std::copy_n(node.pose.x.v, 3, to.place);
      std::copy_n(f.wrench.v, 3, to.force);
      std::copy_n(f.wrench.v + 3, 3, to.moment);
    }
  }
  return nodes;
}

/// The scaled flexibilities of those interfaces that are drawn: of the largest conditions.
void keep_flexibilities(std::vector<solve::InterfaceReport>& interfaces, const step::System& system,
                        records::Profile& out) {
  constexpr std::size_t most_drawn = 6, most_unknowns = 96;
  std::vector<const solve::InterfaceReport*> order;
  for (const solve::InterfaceReport& i : interfaces)
    if (!i.matrices.unknowns.empty() && i.matrices.unknowns.size() <= most_unknowns) order.push_back(&i);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->condition > b->condition; });
  order.resize(std::min(order.size(), most_drawn));
  const std::vector<std::int64_t>& first_of = system.linear().tree().unknown_begin;
  for (const solve::InterfaceReport* i : order) {
    records::SubdomainProfile& to = out.subdomains[at(i->subdomain)];
    const std::size_t n = i->matrices.unknowns.size();
    for (const std::int64_t u : i->matrices.unknowns) {
      const int block = system.linear().tree().block_of_unknown(u);
      to.unknowns.push_back(system.linear().owners().name(block) + ", " + std::to_string(u - first_of[at(block)] + 1));
    }
    to.flexibility.resize(n * n);
    for (std::size_t k = 0; k < n * n; ++k)
      to.flexibility[k] =
          std::sqrt(i->matrices.penalty[k % n] * i->matrices.penalty[k / n]) * i->matrices.flexibility[k];
  }
}

void fill_subdomains(const Found& found, const VisitMedians& m, records::Profile& out) {
  const std::vector<std::int64_t> own_entries = count_matrix_entries(found.graph, found.tree);
  out.subdomains.resize(at(found.tree.num_subdomains()));  // some have flexibilities already
  for (int s = 0; s < found.tree.num_subdomains(); ++s) {
    const tree::Subdomain& sub = found.tree.subdomains[at(s)];
    records::SubdomainProfile& p = out.subdomains[at(s)];
    p.id = s;
    p.parent = sub.parent;
    p.level = sub.level;
    p.is_leaf = sub.is_leaf();
    p.num_elements = sub.element_end - sub.element_begin;
    p.num_fronts = sub.front_end - sub.front_begin;
    p.interface_unknowns = found.tree.fronts[at(sub.top())].num_boundary;
    p.flops = sub.flops;
    p.subtree_flops = sub.subtree_flops;
    for (tree::FrontId f = sub.front_begin; f < sub.front_end; ++f) {
      const std::int64_t e = found.tree.fronts[at(f)].num_eliminated, b = found.tree.fronts[at(f)].num_boundary;
      p.num_unknowns += static_cast<int>(e);
      p.factor_entries += e * e + 2 * e * b;
    }
    p.fill = p.factor_entries - own_entries[at(s)];
    p.subtree_unknowns = p.num_unknowns;
    for (tree::SubdomainId c : found.tree.children(sub)) p.subtree_unknowns += out.subdomains[at(c)].subtree_unknowns;
  }
  for (std::size_t v = 0; v < found.shapes.visits.size(); ++v) {
    const solve::VisitShape& shape = found.shapes.visits[v];
    const auto share = 1.0 / static_cast<double>(shape.subdomains.size());
    records::SubdomainTimes t;
    const double evaluated = m.stage[of(Stage::evaluate)][v];
    t.evaluate = m.evaluate[v] * share;
    t.move = m.move[v] * share;
    t.assemble = m.stage[of(Stage::assemble)][v] * share;
    const double forward_inside = m.stage[of(Stage::forward)][v];
    const double elimination =
        std::max(0.0, m.seconds[of(Work::factor)][v] - evaluated - m.stage[of(Stage::assemble)][v] - forward_inside) *
        share;
    t.condense = shape.flops > 0.0 ? elimination * std::min(1.0, shape.condense_flops / shape.flops) : 0.0;
    t.factor = elimination - t.condense;
    const double condensed = m.seconds[of(Work::forward)][v];
    t.forward = ((condensed > 0.0 ? std::max(0.0, condensed - m.evaluate[v]) : 0.0) + forward_inside) * share;
    t.backward = (m.seconds[of(Work::backward)][v] - m.move[v]) * share;
    t.residual = m.seconds[of(Work::residual)][v] * share;
    t.wait = m.wait[v];
    for (tree::SubdomainId s : shape.subdomains) {
      records::SubdomainProfile& p = out.subdomains[at(s)];
      p.visit = static_cast<int>(v);
      p.num_in_visit = static_cast<int>(shape.subdomains.size());
      p.times = t;
      p.bytes = static_cast<double>(shape.factor_bytes + shape.element_bytes) * share;
    }
    if (shape.in_lanes) out.num_in_lanes += static_cast<int>(shape.subdomains.size());
    out.factor_bytes += shape.factor_bytes;
    out.element_bytes += shape.element_bytes;
  }
  for (const solve::InterfaceReport& i : found.interfaces) {
    out.subdomains[at(i.subdomain)].condition = i.condition;
    out.subdomains[at(i.subdomain)].spectrum = i.spectrum;
  }
  for (std::size_t s = out.subdomains.size(); s-- > 0;) {  // parents first
    const std::string& above = out.subdomains[s].path;
    int k = 0;
    for (tree::SubdomainId c : found.tree.children(found.tree.subdomains[s]))
      out.subdomains[at(c)].path = above + (above.empty() ? "" : ".") + std::to_string(k++);
    if (!found.interface_nodes.empty()) out.subdomains[s].nodes = found.interface_nodes[s];
  }
  records::sum_subtrees(out.subdomains);
  out.levels = records::sum_levels(out.subdomains);
}

void fill_events(const WatchedRun& run, records::Profile& out) {
  static constexpr const char* names[] = {"other", "evaluate", "factor", "forward", "backward", "residual"};
  std::vector<std::vector<int>> visits_by_thread(at(out.num_visits), std::vector<int>(run.times.thread_busy.size(), 0));
  for (const schedule::TimedEvent& e : run.times.events) {
    out.events.push_back(
        {names[of(e.work)], e.is_chunk ? -1 : e.item, e.item, e.thread, e.begin, static_cast<double>(e.seconds)});
    if (!e.is_chunk && e.work == Work::factor && e.item < out.num_visits && e.thread >= 0)
      ++visits_by_thread[at(e.item)][at(e.thread)];
  }
  const double last = run.times.events.empty() ? 0.0 : run.times.events.back().begin;
  for (std::size_t k = 0; k < run.kept_steps.size() && run.kept_steps[k].begin <= last; ++k)
    out.events.push_back({"step", -1, static_cast<int>(k), -1, run.kept_steps[k].begin, run.kept_steps[k].seconds});
  out.events_left_out = run.times.events_left_out;
  for (records::SubdomainProfile& s : out.subdomains) {
    const std::vector<int>& counts = visits_by_thread[at(s.visit)];
    if (!counts.empty()) s.thread = static_cast<int>(std::max_element(counts.begin(), counts.end()) - counts.begin());
  }
}

/// Means over the timed steps, without the start; total and rest are based on medians.
records::StepProfile mean_step(const WatchedRun& run, std::size_t num_visits) {
  records::StepProfile s;
  const auto n = static_cast<double>(std::max<std::size_t>(run.watched.size(), 1));
  s.total = median(run.steps);
  const TreeTimes *end = walked_tree(run.times, num_visits), *begin = walked_tree(run.start, num_visits);
  const auto wall = [&](Work w) {
    if (end == nullptr) return 0.0;
    return (end->work[of(w)].wall_sum - (begin != nullptr ? begin->work[of(w)].wall_sum : 0.0)) / n;
  };
  const auto count = [&](Work w) {
    if (end == nullptr) return 0.0;
    return static_cast<double>(end->work[of(w)].walks - (begin != nullptr ? begin->work[of(w)].walks : 0)) / n;
  };
  s.factor = wall(Work::factor);
  s.forward = wall(Work::forward);
  s.backward = wall(Work::backward);
  s.residual = wall(Work::residual);
  s.factorizations = count(Work::factor);
  s.condensations = count(Work::forward);
  s.solutions = count(Work::backward);
  s.checks = count(Work::residual);
  s.evaluate = wall(Work::evaluate);
  s.evaluations = count(Work::evaluate);
  for (std::size_t w = 0; w < schedule::num_works; ++w) s.walks += count(static_cast<Work>(w));
  for (std::size_t w = 0; w < run.times.chunks.size(); ++w)
    s.other_chunks += (run.times.chunks[w].wall_sum - run.start.chunks[w].wall_sum) / n;
  s.rest =
      std::max(0.0, median(run.watched) - s.evaluate - s.other_chunks - s.factor - s.forward - s.backward - s.residual);
  return s;
}

/// Median duration of one factorization and solution.
double measured_solution(const WatchedRun& run, std::size_t num_visits) {
  const TreeTimes* t = walked_tree(run.times, num_visits);
  double sum = 0.0;
  if (t == nullptr) return sum;
  for (Work w : walks) {
    const auto m = medians(t->work[of(w)].wall, 1);
    sum += m.front();
  }
  return sum;
}

/// Bytes of factors and element matrices that one walk reads or writes. Symmetric factors have one triangle, which both
/// substitutions read.
double walk_bytes(Work w, const records::Profile& p, bool is_symmetric) {
  const auto factors = static_cast<double>(p.factor_bytes), elements = static_cast<double>(p.element_bytes);
  if (w == Work::factor) return factors + elements;
  if (w == Work::residual) return elements;
  return is_symmetric ? factors : 0.5 * factors;
}

/// Predicts the times for other numbers of threads from visits that ran on one thread.
void predict_threads(const Found& found, const VisitMedians& m, const WatchedRun& alone, records::Profile& out) {
  constexpr double grain = schedule::Threads::usual_grain_flops;
  const std::vector<int> threads{1, 2, 4, 8, 16, 32, 64};
  std::vector<double> seconds(found.shapes.visits.size(), 0.0);
  std::vector<records::ThreadsProfile> rows(threads.size());
  for (std::size_t k = 0; k < threads.size(); ++k) rows[k].threads = threads[k];
  const records::StepProfile step = mean_step(alone, found.shapes.visits.size());
  const double per_step[] = {step.factorizations, step.condensations, step.solutions, step.checks};
  const std::vector<double> rates =
      measure_read_rates(static_cast<std::size_t>(out.factor_bytes + out.element_bytes), threads, out.machine_threads);
  for (std::size_t k = 0; k < threads.size(); ++k) {
    rows[k].read_rate = rates[k];
    rows[k].predicted_with_memory = 0.0;
  }
  static constexpr const char* names[] = {"factor", "forward", "backward", "residual"};
  for (std::size_t w = 0; w < std::size(walks); ++w) {
    const auto direction = walks[w] == Work::backward ? Direction::down : Direction::up;
    VisitTimes times(m.seconds[of(walks[w])]);
    if (walks[w] == Work::factor) times = {times.seconds, m.shared, m.parts};
    records::WalkProfile walk =
        simulate_walk(found.shapes.walk, times, direction, threads, grain,
                      walk_bytes(walks[w], out, found.options.symmetry != solve::Symmetry::general), rates);
    if (walk.total == 0.0) continue;  // solutions are not checked
    walk.work = names[w];
    out.critical_path += walk.critical_path;
    for (std::size_t k = 0; k < threads.size(); ++k) {
      rows[k].predicted += walk.seconds[k];
      rows[k].predicted_with_memory += std::max(walk.seconds[k], walk.memory_seconds[k]);
      rows[k].predicted_step += per_step[w] * walk.seconds[k];
    }
    out.walks.push_back(std::move(walk));
  }
  for (records::ThreadsProfile& r : rows)
    r.predicted_step += step.rest + (step.evaluate + step.other_chunks) / r.threads;
  out.total = rows.front().predicted;
  out.speed = rows;
}

}  // namespace

records::Profile profile(const scene::Scene& given, const ProfileOptions& options, records::Recorder& recorder,
                         const run::ProgressCallback& progress) {
  scene::Scene scene = given;
  scene.without.push_back("small");  // times are wanted for the requested number of threads, whether they pay or not
  records::Profile out;
  out.scene = scene.name;
  out.title = scene.title;
  out.threads = scene.solver.tasks ? options.threads : 1;
  out.machine_threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  out.widest_condition = options.widest_condition;
  Found found;
  const auto look = [&](step::System& system, const step::State& state) {
    found.tree = system.linear().tree();
    found.graph = system.plan().graph;
    found.options = step::make_solve_options(system.plan(), scene.solver);
    found.options.lanes = found.options.lanes && system.linear().solver().hierarchical() != nullptr;
    found.shapes = solve::make_visit_shapes(found.graph, found.tree, found.options);
    found.counters = system.linear().solver().counters();
    if (system.counts().factorizations > 0 && system.linear().solver().last_status().ok())
      found.interfaces =
          system.linear().solver().interfaces(schedule::make_serial_walker(), options.widest_condition, true);
    out.subdomains.resize(at(found.tree.num_subdomains()));
    keep_flexibilities(found.interfaces, system, out);
    found.interface_nodes = eval_interface_nodes(system, state);
    out.is_dynamic = system.plan().is_dynamic;
    draw_parts(system.plan(), found.tree, out);
  };
  const WatchedRun run =
      watch_run(scene, {.threads = out.threads, .steps = options.steps, .keep_events = true}, recorder, progress, look);
  if (run.summary.status == records::RunStatus::failed) out.trouble = run.summary.cause;
  out.steps = run.summary.steps.accepted;
  out.factorizations = run.summary.steps.factorizations;
  out.solutions = found.counters.solutions;
  out.form = scene::to_string(scene.solver.form);
  out.cut = found.tree.method;
  out.num_visits = static_cast<int>(found.shapes.visits.size());
  out.solver_bytes = found.counters.memory_bytes;
  out.peak_bytes = run.summary.memory_peak_bytes;
  const VisitMedians measured = find_medians(run.times, found.shapes.visits.size());
  fill_subdomains(found, measured, out);
  fill_events(run, out);
  out.step = mean_step(run, found.shapes.visits.size());
  out.thread_busy = run.times.thread_busy;
  double busy = 0.0, most = 0.0, wall = 0.0;
  for (double b : out.thread_busy) {
    busy += b;
    most = std::max(most, b);
  }
  for (const TreeTimes& t : run.times.trees)
    for (const schedule::WorkTimes& w : t.work) wall += w.wall_sum;
  for (const schedule::ChunkTimes& c : run.times.chunks) wall += c.wall_sum;
  if (most > 0.0) out.load_balance = busy / (out.threads * most);
  if (wall > 0.0) out.efficiency = busy / (out.threads * wall);
  const bool has_visits = walked_tree(run.times, found.shapes.visits.size()) != nullptr;
  if (out.steps == 0 || !has_visits) return out;

  NullRecorder nobody;
  WatchedRun alone;
  const auto go_on = [&progress](const records::Progress& p) { return !progress || progress(p); };
  const auto run_on = [&](int threads) {
    return watch_run(scene, {.threads = threads, .steps = std::min(options.steps, options.steps_for_speed)}, nobody,
                     go_on);
  };
  if (out.threads != 1) alone = run_on(1);
  const WatchedRun& one = out.threads == 1 ? run : alone;
  predict_threads(found, find_medians(one.times, found.shapes.visits.size()), one, out);
  for (records::ThreadsProfile& row : out.speed) {
    if (row.threads > std::max(out.machine_threads, out.threads) || (row.threads > 1 && !scene.solver.tasks)) continue;
    WatchedRun other;
    if (row.threads != 1 && row.threads != out.threads) other = run_on(row.threads);
    const WatchedRun& r = row.threads == 1 ? one : row.threads == out.threads ? run : other;
    row.measured = measured_solution(r, found.shapes.visits.size());
    row.measured_step = median(r.steps);
  }
  const VisitMedians serial = find_medians(one.times, found.shapes.visits.size());
  std::vector<double> seconds;
  for (std::size_t v = 0; v < found.shapes.visits.size(); ++v) seconds.push_back(serial.solver(v));
  out.costs = fit_costs(found.shapes.visits, seconds);
  out.alternatives = try_alternatives(found.graph, found.tree, scene.solver, out.threads,
                                      schedule::Threads::usual_grain_flops, out.costs, found.options);
  return out;
}

}  // namespace bough::study
