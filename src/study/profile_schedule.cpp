#include "profile_schedule.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

#include "bough/blocks/at.hpp"

namespace bough::study {

namespace {

/// Tasks of a walk as a tree; parents before children.
struct Task {
  int parent = -1;
  double seconds = 0.0;
  double shared = 0.0, parts = 1.0;  ///< of a single visit: see VisitTimes
  double remaining = 0.0;            ///< longest sum along what depends on it, itself included
  int open = 0;                      ///< number of tasks that have to be done before
};

double least_seconds(const VisitTimes& t, std::size_t v) {
  return t.shared.empty() ? t.seconds[v] : t.seconds[v] - t.shared[v] + t.shared[v] / t.parts[v];
}

std::vector<Task> cut_into_tasks(const tree::Tree& walk, const VisitTimes& times, double grain_flops) {
  std::vector<Task> tasks;
  std::vector<std::pair<tree::SubdomainId, int>> open{{walk.root(), -1}};
  while (!open.empty()) {
    const auto [id, parent] = open.back();
    open.pop_back();
    const tree::Subdomain& s = walk.subdomains[at(id)];
    Task task{.parent = parent};
    const bool is_whole = s.is_leaf() || s.subtree_flops < grain_flops;
    for (tree::SubdomainId v = is_whole ? s.subtree_begin : id; v <= id; ++v) task.seconds += times.seconds[at(v)];
    if (!is_whole && !times.shared.empty()) {
      task.shared = times.shared[at(id)];
      task.parts = times.parts[at(id)];
    }
    const int index = static_cast<int>(tasks.size());
    tasks.push_back(task);
    if (is_whole) continue;
    for (auto c = s.child_begin; c < s.child_end; ++c) open.emplace_back(walk.subdomain_children[at(c)], index);
  }
  return tasks;
}

}  // namespace

double critical_path(const tree::Tree& walk, const VisitTimes& times) {
  std::vector<double> path(times.seconds.size(), 0.0);
  for (std::size_t v = 0; v < path.size(); ++v) {  // children come before their parents
    path[v] += least_seconds(times, v);
    const tree::SubdomainId parent = walk.subdomains[v].parent;
    if (parent != tree::none) path[at(parent)] = std::max(path[at(parent)], path[v]);
  }
  return path.empty() ? 0.0 : path.back();
}

double eval_walk(const tree::Tree& walk, const VisitTimes& times, Direction direction, int threads,
                 double grain_flops) {
  std::vector<Task> tasks = cut_into_tasks(walk, times, grain_flops);
  std::vector<std::vector<int>> next(tasks.size());
  if (direction == Direction::up) {
    for (std::size_t k = 0; k < tasks.size(); ++k) {
      Task& t = tasks[k];
      t.remaining = t.seconds + (t.parent >= 0 ? tasks[at(t.parent)].remaining : 0.0);
      if (t.parent < 0) continue;
      next[k].push_back(t.parent);
      ++tasks[at(t.parent)].open;
    }
  } else {
    for (std::size_t k = tasks.size(); k-- > 0;) {
      Task& t = tasks[k];
      t.remaining += t.seconds;
      if (t.parent < 0) continue;
      tasks[at(t.parent)].remaining = std::max(tasks[at(t.parent)].remaining, t.remaining);
      next[at(t.parent)].push_back(static_cast<int>(k));
      t.open = 1;
    }
  }
  std::priority_queue<std::pair<double, int>> ready;  // longest remaining path first, then the higher index
  using Busy = std::pair<double, int>;                // until, task
  std::priority_queue<Busy, std::vector<Busy>, std::greater<>> busy;
  constexpr int helper = -1;  // a thread that shares the loops of a task
  for (std::size_t k = 0; k < tasks.size(); ++k)
    if (tasks[k].open == 0) ready.emplace(tasks[k].remaining, static_cast<int>(k));
  double now = 0.0;
  while (!ready.empty() || !busy.empty()) {
    std::vector<int> begun;
    while (!ready.empty() && static_cast<int>(busy.size() + begun.size()) < threads) {
      begun.push_back(ready.top().second);
      ready.pop();
    }
    int idle = threads - static_cast<int>(busy.size() + begun.size());
    for (const int k : begun) {
      const Task& t = tasks[at(k)];
      const int helpers = t.shared > 0.0 ? std::min(idle, static_cast<int>(t.parts) - 1) : 0;
      idle -= helpers;
      const double until = now + t.seconds - t.shared + t.shared / (1 + helpers);
      for (int h = 0; h < helpers; ++h) busy.emplace(until, helper);
      busy.emplace(until, k);
    }
    now = busy.top().first;
    const int done = busy.top().second;
    busy.pop();
    if (done == helper) continue;
    for (int k : next[at(done)])
      if (--tasks[at(k)].open == 0) ready.emplace(tasks[at(k)].remaining, k);
  }
  return now;
}

std::vector<double> eval_walks(const tree::Tree& walk, const VisitTimes& times, Direction direction,
                               const std::vector<int>& threads, double grain_flops) {
  std::vector<double> durations;
  double least = std::numeric_limits<double>::infinity();
  for (int p : threads) {
    least = std::min(least, eval_walk(walk, times, direction, p, grain_flops));
    durations.push_back(least);
  }
  return durations;
}

records::WalkProfile simulate_walk(const tree::Tree& walk, const VisitTimes& times, Direction direction,
                                   const std::vector<int>& threads, double grain_flops, double bytes,
                                   const std::vector<double>& read_rates) {
  records::WalkProfile p;
  p.total = std::accumulate(times.seconds.begin(), times.seconds.end(), 0.0);
  p.critical_path = critical_path(walk, times);
  p.bytes = bytes;
  p.seconds = eval_walks(walk, times, direction, threads, grain_flops);
  for (double rate : read_rates) p.memory_seconds.push_back(bytes / rate);
  return p;
}

}  // namespace bough::study
