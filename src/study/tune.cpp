#include "bough/study/tune.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "bough/plan/plan.hpp"
#include "bough/run/simulate.hpp"
#include "bough/solve/reference/monolithic.hpp"
#include "bough/tree/tree.hpp"
#include "profile_run.hpp"

namespace bough::study {

namespace {

using scene::Solver;
using scene::SolverForm;

constexpr double too_slow = 2.5;     // relative to the fastest of the first round
constexpr double least_gain = 0.02;  // a smaller gain is noise, or not worth a change
constexpr int least_rounds = 3;

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool has_tree(SolverForm form) { return form != SolverForm::monolithic; }

/// Seconds of a step in one short run; fills `failure` instead where the run fails or there is no step.
double time_run(const scene::Scene& scene, const TuneOptions& options, std::string& failure) {
  using Clock = std::chrono::steady_clock;
  Clock::time_point start, first, last;
  long done = 0;
  run::SimulateOptions simulate_options;
  simulate_options.threads = options.threads;
  simulate_options.before_step = [&](step::System&, const step::State&, const run::BeforeStep& attempt) {
    if (attempt.number > options.steps) return false;
    if (attempt.number == 1 && done == 0) start = Clock::now();
    return true;
  };
  NullRecorder nobody;
  const records::Summary summary = run::simulate(scene, simulate_options, nobody, [&](const records::Progress&) {
    last = Clock::now();
    if (done++ == 0) first = last;
    return true;
  });
  if (summary.status == records::RunStatus::failed)
    failure = summary.cause;
  else if (done == 0)
    failure = "the run has no step";
  if (!failure.empty()) return std::numeric_limits<double>::quiet_NaN();
  if (done == 1) return std::chrono::duration<double>(last - start).count();
  return std::chrono::duration<double>(last - first).count() / static_cast<double>(done - 1);
}

struct Shape {
  int subdomains = 0, levels = 0, fronts = 0;
  double flops = 0.0;
  int largest_leaf = 1;
  bool operator==(const Shape& o) const {
    return subdomains == o.subdomains && levels == o.levels && fronts == o.fronts && flops == o.flops;
  }
};

Shape shape_of(const plan::Plan& plan, const Solver& solver) {
  const tree::Tree tree = tree::make_tree(plan.graph, step::make_tree_options(plan, solver));
  Shape s{.subdomains = tree.num_subdomains(), .fronts = tree.num_fronts()};
  for (const tree::Subdomain& d : tree.subdomains) {
    s.levels = std::max(s.levels, d.level + 1);
    s.flops += d.flops;
    if (d.is_leaf()) s.largest_leaf = std::max(s.largest_leaf, d.element_end - d.element_begin);
  }
  return s;
}

class Tuner {
 public:
  Tuner(const scene::Scene& scene, const TuneOptions& options, const std::function<bool(int, int)>& progress)
      : scene_(scene), options_(options), progress_(progress), plan_(plan::make_plan(scene)) {
    if (!scene.solver.tasks) options_.threads = 1;
  }

  TuneResult run() {
    propose();
    const auto start = std::chrono::steady_clock::now();
    TuneResult result;
    bool goes_on = run_round();
    if (goes_on) goes_on = propose_without_tasks();
    drop_slow();
    for (result.rounds = 1; goes_on && result.rounds < options_.rounds; ++result.rounds) {
      const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      if (result.rounds >= least_rounds && elapsed > options_.seconds) break;
      goes_on = run_round();
    }
    judge(result);
    return result;
  }

 private:
  /// Adds a candidate unless another one of its form has the same tree.
  void add(Solver solver) {
    Shape shape;
    if (has_tree(solver.form)) {
      shape = shape_of(plan_, solver);
      for (std::size_t k = 0; k < shapes_.size(); ++k)
        if (list_[k].solver.tasks == solver.tasks && list_[k].solver.form == solver.form && shapes_[k] == shape) return;
    }
    TuneCandidate c{.solver = solver, .num_subdomains = shape.subdomains, .num_levels = shape.levels};
    c.is_present = list_.empty();
    list_.push_back(c);
    shapes_.push_back(shape);
  }

  void propose() {
    add(scene_.solver);
    Solver tree = scene_.solver;
    tree.form = SolverForm::local;
    tree.leaf_size = 0;
    tree.depth = -1;
    const Shape chosen = shape_of(plan_, tree);
    add(tree);
    for (int factor : {4, 2}) {
      tree.leaf_size = std::max(1, chosen.largest_leaf / factor);
      add(tree);
    }
    for (int factor : {2, 4}) {
      tree.leaf_size = std::min(plan_.graph.num_elements(), chosen.largest_leaf * factor);
      add(tree);
    }
    tree.leaf_size = 0;
    for (int depth : {chosen.levels - 2, chosen.levels, 0}) {
      tree.depth = std::max(0, depth);
      add(tree);
    }
    Solver whole = scene_.solver;
    whole.form = SolverForm::monolithic;
    for (scene::SolverLibrary library : {scene::SolverLibrary::klu, scene::SolverLibrary::sparse_lu}) {
      if (library == scene::SolverLibrary::klu && !solve::Monolithic::available()) continue;
      whole.library = library;
      if (scene_.solver.form != SolverForm::monolithic || scene_.solver.library != library) add(whole);
    }
  }

  /// Runs every remaining candidate once; false if asked to stop.
  bool run_round() {
    for (TuneCandidate& c : list_)
      if (c.failure.empty() && !run_one(c)) return false;
    return true;
  }

  bool run_one(TuneCandidate& c) {
    scene::Scene scene = scene_;
    scene.solver = c.solver;
    scene.output.checks = false;
    scene.analysis.errors = {};
    const double seconds = time_run(scene, options_, c.failure);
    if (c.failure.empty()) c.seconds.push_back(seconds);
    ++done_;
    const auto open = std::count_if(list_.begin(), list_.end(), [](const auto& x) { return x.failure.empty(); });
    return !progress_ || progress_(done_, std::max(done_, options_.rounds * static_cast<int>(open)));
  }

  /// Tasks cost more than they gain in a small tree: the fastest tree is also tried without them.
  bool propose_without_tasks() {
    if (options_.threads == 1) return true;
    const TuneCandidate* best = nullptr;
    for (const TuneCandidate& c : list_)
      if (c.failure.empty() && has_tree(c.solver.form) && (best == nullptr || c.seconds.back() < best->seconds.back()))
        best = &c;
    if (best == nullptr) return true;
    Solver solver = best->solver;
    solver.tasks = false;
    const std::size_t before = list_.size();
    add(solver);
    return list_.size() == before || run_one(list_.back());
  }

  void drop_slow() {
    double best = std::numeric_limits<double>::infinity();
    for (const TuneCandidate& c : list_)
      if (!c.seconds.empty()) best = std::min(best, c.seconds.front());
    for (TuneCandidate& c : list_)
      if (!c.is_present && !c.seconds.empty() && c.seconds.front() > too_slow * best)
        c.failure = "more than 2.5 times the fastest";
  }

  void judge(TuneResult& result) {
    for (TuneCandidate& c : list_) {
      if (c.seconds.empty()) continue;
      c.median = median_of(c.seconds);
      c.low = *std::min_element(c.seconds.begin(), c.seconds.end());
      c.high = *std::max_element(c.seconds.begin(), c.seconds.end());
    }
    std::stable_sort(list_.begin(), list_.end(), [](const TuneCandidate& a, const TuneCandidate& b) {
      const bool in_a = a.failure.empty() && !a.seconds.empty(), in_b = b.failure.empty() && !b.seconds.empty();
      return in_a != in_b ? in_a : a.median < b.median;
    });
    const auto present = std::find_if(list_.begin(), list_.end(), [](const auto& c) { return c.is_present; });
    result.present = result.best = static_cast<std::size_t>(present - list_.begin());
    double best_ratio = 1.0 - least_gain;
    for (std::size_t k = 0; k < list_.size(); ++k) {
      const TuneCandidate& c = list_[k];
      if (c.is_present || !c.failure.empty() || c.seconds.empty()) continue;
      if (!present->failure.empty() || present->seconds.empty()) {  // the scene's own options fail
        result.best = k;
        break;
      }
      std::vector<double> ratios;
      int wins = 0;
      for (std::size_t r = 0; r < std::min(c.seconds.size(), present->seconds.size()); ++r) {
        ratios.push_back(c.seconds[r] / present->seconds[r]);
        wins += ratios.back() < 1.0 ? 1 : 0;
      }
      const double ratio = median_of(ratios);
      if (4 * wins < 3 * static_cast<int>(ratios.size()) || ratio > best_ratio) continue;
      best_ratio = ratio;
      result.best = k;
      result.gain = 1.0 - ratio;
    }
    result.candidates = std::move(list_);
  }

  const scene::Scene& scene_;
  TuneOptions options_;
  const std::function<bool(int, int)>& progress_;
  plan::Plan plan_;
  std::vector<TuneCandidate> list_;
  std::vector<Shape> shapes_;
  int done_ = 0;
};

}  // namespace

TuneResult tune(const scene::Scene& scene, const TuneOptions& options, const std::function<bool(int, int)>& progress) {
  return Tuner(scene, options, progress).run();
}

}  // namespace bough::study
