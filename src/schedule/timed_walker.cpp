#include "bough/schedule/timed_walker.hpp"

#include <algorithm>
#include <chrono>
#include <type_traits>
#ifdef BOUGH_HAS_TBB
#include <tbb/task_arena.h>

#include "bough/blocks/at.hpp"
#endif

namespace bough::schedule {

namespace {

bool has_stages(tree::Work work) {
  return work == tree::Work::factor || work == tree::Work::forward || work == tree::Work::backward;
}

constexpr int most_threads = 1024;

using Clock = std::chrono::steady_clock;

/// The counter that is fastest to read. The length of a tick is calibrated with the steady clock over the whole timing.
std::uint64_t ticks() {
#if defined(__x86_64__)
  return __builtin_ia32_rdtsc();
#else
  return static_cast<std::uint64_t>(Clock::now().time_since_epoch().count());
#endif
}

/// One visit of the present walk.
struct Record {
  std::uint64_t begin, last, end;
  std::array<std::uint64_t, num_stages> stage;
  int thread;
  std::uint64_t shared;  ///< in loops of the visit that threads share out
  double parts;          ///< of these loops, times their ticks
};

struct Watched {
  const tree::Tree* tree;
  TreeTimes times;  ///< in ticks
  std::vector<Record> records;
};

thread_local Record* current = nullptr;

/// Index of the calling thread among those that have walked. Worker threads come and go, indices remain.
int thread_number() {
#ifdef BOUGH_HAS_TBB
  return std::clamp(tbb::this_task_arena::current_thread_index(), 0, most_threads - 1);
#else
  return 0;
#endif
}

struct Busy {
  alignas(64) std::uint64_t ticks = 0;
};

}  // namespace

struct TimedWalker::State {
  State(const tree::Walker& w, const TimedWalkerOptions& o) : inner(w), options(o), busy(most_threads) {}

  Watched& watched(const tree::Tree& tree) {
    for (Watched& w : trees)
      if (w.tree == &tree && w.times.num_visits == tree.num_subdomains()) return w;
    Watched w{&tree, {}, std::vector<Record>(at(tree.num_subdomains()))};
    w.times.num_visits = tree.num_subdomains();
    trees.push_back(std::move(w));
    return trees.back();
  }

  template <class Walk>
  void watch(const tree::Tree& tree, tree::Visit given, bool is_upward, Walk&& walk) {
    if (!is_on) {
      walk(given);
      return;
    }
    is_walking = true;
    if (given.work == tree::Work::other) {
      walk(given);
    } else {
      watch_named(tree, given, is_upward, walk);
    }
    is_walking = false;
  }

  template <class Walk>
  void watch_named(const tree::Tree& tree, tree::Visit given, bool is_upward, Walk& walk) {
    Watched& w = watched(tree);
    visit = given;
    records = w.records.data();
    const std::uint64_t begin = ticks();
    walk(tree::Visit{&State::run_visit, this, given.work});
    const std::uint64_t end = ticks();
    keep(w, tree, given.work, is_upward, end - begin);
  }

  static void run_visit(void* context, tree::SubdomainId s) {
    State& state = *static_cast<State*>(context);
    Record& r = state.records[s];
    r.thread = thread_number();
    r.stage.fill(0);
    r.shared = 0;
    r.parts = 0.0;
    current = &r;
    r.begin = r.last = ticks();
    state.visit.run(state.visit.context, s);
    r.end = ticks();
    current = nullptr;
    state.busy[at(r.thread)].ticks += r.end - r.begin;
  }

  static void run_mark(void* context, tree::Stage done) {
    Record* r = current;
    if (r == nullptr) return;
    const std::uint64_t now = ticks();
    r->stage[static_cast<std::size_t>(done)] += now - r->last;
    r->last = now;
    (void)context;
  }

  static void run_chunk(void* context, std::int64_t begin, std::int64_t end) {
    State& state = *static_cast<State*>(context);
    const std::size_t index = at(begin / state.chunk_grain);
    Record& r = state.chunk_records[index];
    r.thread = thread_number();
    r.begin = ticks();
    state.chunk.run(state.chunk.context, begin, end);
    r.end = ticks();
    state.busy[at(r.thread)].ticks += r.end - r.begin;
  }

  void keep(Watched& w, const tree::Tree& tree, tree::Work work, bool is_upward, std::uint64_t wall) {
    WorkTimes& t = w.times.work[static_cast<std::size_t>(work)];
    const int n = w.times.num_visits;
    if (keeps_events)
      for (int v = 0; v < n; ++v) add_event(work, false, v, w.records[at(v)]);
    t.wall_sum += static_cast<double>(wall);
    if (t.walks++ % t.stride != 0) return;
    if (t.visit.capacity() == 0) reserve(t, n, work, is_upward);
    if (static_cast<std::int64_t>(t.visit.size()) + n > most_values(n)) thin(t, n);
    t.wall.push_back(static_cast<float>(wall));
    for (int v = 0; v < n; ++v) {
      const Record& r = w.records[at(v)];
      t.visit.push_back(static_cast<float>(r.end - r.begin));
      if (has_stages(work))
        for (int k = 0; k < num_stages; ++k) t.stage[at(k)].push_back(static_cast<float>(r.stage[at(k)]));
      if (work == tree::Work::factor) {
        t.shared.push_back(static_cast<float>(r.shared));
        t.parts.push_back(r.shared > 0 ? static_cast<float>(r.parts / static_cast<double>(r.shared)) : 1.0f);
      }
      if (!is_upward) continue;
      std::uint64_t ready = 0;
      const tree::Subdomain& s = tree.subdomains[at(v)];
      for (auto c = s.child_begin; c < s.child_end; ++c)
        ready = std::max(ready, w.records[at(tree.subdomain_children[at(c)])].end);
      t.wait.push_back(ready > 0 && r.begin > ready ? static_cast<float>(r.begin - ready) : 0.0f);
    }
  }

  std::int64_t most_values(int n) const { return std::max<std::int64_t>(options.most_samples / n, 2) * n; }

  void reserve(WorkTimes& t, int n, tree::Work work, bool is_upward) const {
    const std::size_t most = at(most_values(n));
    t.visit.reserve(most);
    t.wall.reserve(most / at(n));
    if (is_upward) t.wait.reserve(most);
    if (work == tree::Work::factor)
      for (auto* v : {&t.shared, &t.parts}) v->reserve(most);
    if (has_stages(work))
      for (auto& s : t.stage) s.reserve(most);
  }

  /// Drops every other sample; from now on half as many walks are sampled.
  static void thin(WorkTimes& t, int n) {
    const auto halve = [](std::vector<float>& values, std::size_t row) {
      const std::size_t rows = values.size() / row;
      for (std::size_t k = 0; 2 * k < rows; ++k)
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(2 * k * row), row,
                    values.begin() + static_cast<std::ptrdiff_t>(k * row));
      values.resize((rows + 1) / 2 * row);
    };
    halve(t.visit, at(n));
    halve(t.wait, at(n));
    halve(t.shared, at(n));
    halve(t.parts, at(n));
    halve(t.wall, 1);
    for (auto& s : t.stage) halve(s, at(n));
    t.stride *= 2;
  }

  void add_event(tree::Work work, bool is_chunk, int item, const Record& r) {
    if (static_cast<std::int64_t>(events.size()) >= options.most_events) {
      ++events_left_out;
      return;
    }
    events.push_back({work, is_chunk, item, r.thread, static_cast<float>(r.end - r.begin),
                      static_cast<double>(r.begin - first_tick)});
  }

  void watch_chunks(std::int64_t count, std::int64_t grain, tree::Chunk given) {
    const std::int64_t num_chunks = (count + grain - 1) / grain;
    if (Record* r = is_walking ? current : nullptr; r != nullptr) {
      const std::uint64_t begin = ticks();
      inner.for_each_chunk(count, grain, given);
      const std::uint64_t taken = ticks() - begin;
      r->shared += taken;
      r->parts += static_cast<double>(taken) * static_cast<double>(num_chunks * given.parts);
      return;
    }
    if (count <= 0 || is_walking || !is_on) {
      inner.for_each_chunk(count, grain, given);
      return;
    }
    if (static_cast<std::int64_t>(chunk_records.size()) < num_chunks) chunk_records.resize(at(num_chunks));
    chunk = given;
    chunk_grain = grain;
    const std::uint64_t begin = ticks();
    inner.for_each_chunk(count, grain, {&State::run_chunk, this, given.work});
    const std::uint64_t end = ticks();
    ChunkTimes& t = chunks[static_cast<std::size_t>(given.work)];
    ++t.count;
    t.wall_sum += static_cast<double>(end - begin);
    t.grain = grain;
    if (given.work == tree::Work::evaluate && static_cast<std::int64_t>(t.chunk.size()) < num_chunks)
      t.chunk.resize(at(num_chunks), 0.0);
    for (std::int64_t c = 0; c < num_chunks; ++c) {
      const Record& r = chunk_records[at(c)];
      t.work_sum += static_cast<double>(r.end - r.begin);
      if (given.work == tree::Work::evaluate) t.chunk[at(c)] += static_cast<double>(r.end - r.begin);
      if (keeps_events) add_event(given.work, true, static_cast<int>(c * grain), r);
    }
  }

  double seconds_per_tick() const {
    const auto elapsed = static_cast<double>(ticks() - first_tick);
    return elapsed > 0.0 ? std::chrono::duration<double>(Clock::now() - start).count() / elapsed : 0.0;
  }

  tree::Walker inner;
  TimedWalkerOptions options;
  std::vector<Watched> trees;
  std::array<ChunkTimes, num_works> chunks;  ///< in ticks
  std::vector<Record> chunk_records;
  std::vector<Busy> busy;
  std::vector<TimedEvent> events;  ///< in ticks
  std::int64_t events_left_out = 0;
  bool is_on = true;
  bool keeps_events = false;
  bool is_walking = false;  ///< loops inside visits are part of these, which keep the sum of their times
  // State of the present walk.
  tree::Visit visit;
  tree::Chunk chunk;
  std::int64_t chunk_grain = 1;
  Record* records = nullptr;
  const std::uint64_t first_tick = ticks();
  const Clock::time_point start = Clock::now();
};

TimedWalker::TimedWalker(const tree::Walker& inner, const TimedWalkerOptions& options)
    : state_(std::make_unique<State>(inner, options)) {}

TimedWalker::~TimedWalker() = default;

tree::Walker TimedWalker::walker() {
  return {[](void* context, const tree::Tree& tree, tree::Visit visit) {
            auto* s = static_cast<State*>(context);
            s->watch(tree, visit, true, [&](tree::Visit v) { s->inner.walk_up(tree, v); });
          },
          [](void* context, const tree::Tree& tree, tree::Visit visit) {
            auto* s = static_cast<State*>(context);
            s->watch(tree, visit, false, [&](tree::Visit v) { s->inner.walk_down(tree, v); });
          },
          [](void* context, std::int64_t count, std::int64_t grain, tree::Chunk chunk) {
            static_cast<State*>(context)->watch_chunks(count, grain, chunk);
          },
          state_.get(),
          tree::Mark{&State::run_mark, state_.get()},
          state_->inner.threads};
}

void TimedWalker::watch(bool on) { state_->is_on = on; }

void TimedWalker::keep_events(bool keep) {
  state_->keeps_events = keep;
  if (keep && state_->events.capacity() == 0) state_->events.reserve(at(state_->options.most_events));
}

std::uint64_t TimedWalker::now() const { return ticks() - state_->first_tick; }

WalkTimes TimedWalker::times() const {
  const State& s = *state_;
  const double unit = s.seconds_per_tick();
  const auto scale = [unit](auto& values) {
    for (auto& v : values) v = static_cast<std::decay_t<decltype(v)>>(static_cast<double>(v) * unit);
  };
  WalkTimes out;
  for (const Watched& w : s.trees) {
    out.trees.push_back(w.times);
    for (WorkTimes& t : out.trees.back().work) {
      scale(t.visit);
      scale(t.wait);
      scale(t.shared);
      scale(t.wall);
      for (auto& stage : t.stage) scale(stage);
      t.wall_sum *= unit;
    }
  }
  out.chunks = s.chunks;
  for (ChunkTimes& t : out.chunks) {
    t.wall_sum *= unit;
    t.work_sum *= unit;
    scale(t.chunk);
  }
  std::vector<int> number(most_threads, -1);
  for (int k = 0; k < most_threads; ++k)
    if (s.busy[at(k)].ticks > 0) {
      number[at(k)] = static_cast<int>(out.thread_busy.size());
      out.thread_busy.push_back(static_cast<double>(s.busy[at(k)].ticks) * unit);
    }
  out.events = s.events;
  for (TimedEvent& e : out.events) {
    e.thread = number[at(e.thread)];
    e.begin *= unit;
    e.seconds = static_cast<float>(static_cast<double>(e.seconds) * unit);
  }
  out.events_left_out = s.events_left_out;
  out.seconds_per_tick = unit;
  return out;
}

}  // namespace bough::schedule
