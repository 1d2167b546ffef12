#include "bough/schedule/threads.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <stdexcept>

#include "bough/blocks/at.hpp"
#include "bough/schedule/serial.hpp"
#ifdef BOUGH_HAS_TBB
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#endif

namespace bough::schedule {

#ifdef BOUGH_HAS_TBB
#endif

#ifdef BOUGH_HAS_TBB
namespace {

/// oneTBB looks without a lock whether a global_control lives when an arena starts (2021.8, found by the thread
/// sanitizer). Runs beside each other in one process start and end theirs one by one.
std::mutex& arenas_start() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace
#endif

struct Threads::State {
  State(int n, double grain) : count(n), grain_flops(grain) {}
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  int count;
  double grain_flops;
  std::atomic<unsigned> delay_microseconds{0};
  std::atomic<unsigned> delay_state{1};

#ifdef BOUGH_HAS_TBB
  ~State() {
    const std::lock_guard lock(arenas_start());
    allowance.reset();
  }

  tbb::task_arena arena;
  std::once_flag is_started;
  bool outnumbers_processors = false;
  std::unique_ptr<tbb::global_control> allowance;  ///< oneTBB needs it for more threads than the machine has

  /// Starts the arena with its threads if necessary. TBB takes a third of a millisecond to examine the machine, so a
  /// run without tasks does not start it.
  tbb::task_arena& started() {
    std::call_once(is_started, [this] {
      const std::lock_guard lock(arenas_start());
      outnumbers_processors = count > tbb::info::default_concurrency();
      if (outnumbers_processors)
        allowance = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                          static_cast<std::size_t>(count));
      arena.initialize(count);
    });
    return arena;
  }

  void walk_up(const tree::Tree& tree, tree::Visit visit) {
    walk(tree, [&] { visit_up(tree, tree.root(), visit); });
  }

  void walk_down(const tree::Tree& tree, tree::Visit visit) {
    walk(tree, [&] { visit_down(tree, tree.root(), visit); });
  }

  template <class Visits>
  void walk(const tree::Tree& tree, Visits&& visits) {
    if (is_whole(tree.subdomains[at(tree.root())])) return visits();  // no task is made
    started().execute(visits);
  }

  /// For calls outside of walks or inside a visit.
  void share_chunks(std::int64_t count_items, std::int64_t grain, tree::Chunk chunk) {
    started().execute([&] { run_chunks(count_items, grain, chunk); });
  }

  [[nodiscard]] bool is_whole(const tree::Subdomain& s) const { return s.is_leaf() || s.subtree_flops < grain_flops; }

  void delay() {
    const unsigned limit = delay_microseconds.load(std::memory_order_relaxed);
    if (limit == 0) return;
    unsigned r = delay_state.fetch_add(0x9e3779b9u, std::memory_order_relaxed);
    r ^= r >> 16;
    r *= 0x7feb352du;
    r ^= r >> 15;
    const auto until = std::chrono::steady_clock::now() + std::chrono::microseconds(r % limit);
    while (std::chrono::steady_clock::now() < until) {
    }
  }

  void visit_up(const tree::Tree& tree, tree::SubdomainId top, tree::Visit visit) {
    const tree::Subdomain& s = tree.subdomains[at(top)];
    if (is_whole(s)) {
      delay();
      for (tree::SubdomainId i = s.subtree_begin; i <= top; ++i) visit.run(visit.context, i);
      return;
    }
    tbb::task_group children;
    const auto list = tree.children(s);
    for (std::size_t c = 1; c < list.size(); ++c)
      children.run([this, &tree, id = list[c], visit] { visit_up(tree, id, visit); });
    visit_up(tree, list.front(), visit);  // the first child stays on this thread, as for chunks, so that data mostly
                                          // stay with one processor
    children.wait();
    delay();
    visit.run(visit.context, top);
  }

  void visit_down(const tree::Tree& tree, tree::SubdomainId top, tree::Visit visit) {
    const tree::Subdomain& s = tree.subdomains[at(top)];
    delay();
    if (is_whole(s)) {
      for (tree::SubdomainId i = top; i >= s.subtree_begin; --i) visit.run(visit.context, i);
      return;
    }
    visit.run(visit.context, top);
    tbb::task_group children;
    const auto list = tree.children(s);
    for (std::size_t c = 1; c < list.size(); ++c)
      children.run([this, &tree, id = list[c], visit] { visit_down(tree, id, visit); });
    visit_down(tree, list.front(), visit);
    children.wait();
  }

  void run_chunks(std::int64_t count_items, std::int64_t grain, tree::Chunk chunk) {
    const std::int64_t chunks = (count_items + grain - 1) / grain;
    // Isolated: a thread that waits here inside a visit must not take up another visit.
    tbb::this_task_arena::isolate([&] {
      const auto run = [&](const tbb::blocked_range<std::int64_t>& range) {
        for (std::int64_t c = range.begin(); c < range.end(); ++c) {
          delay();
          chunk.run(chunk.context, c * grain, std::min((c + 1) * grain, count_items));
        }
      };
      tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, chunks), run, tbb::simple_partitioner{});
    });
  }
#endif
};

#ifdef BOUGH_HAS_TBB
namespace {

template <class State>
tree::Walker make_walker(State* state) {
  return {[](void* context, const tree::Tree& tree, tree::Visit visit) {
            static_cast<State*>(context)->walk_up(tree, visit);
          },
          [](void* context, const tree::Tree& tree, tree::Visit visit) {
            static_cast<State*>(context)->walk_down(tree, visit);
          },
          [](void* context, std::int64_t count, std::int64_t grain, tree::Chunk chunk) {
            auto* s = static_cast<State*>(context);
            if (count <= grain) {
              if (count > 0) chunk.run(chunk.context, 0, count);
              return;
            }
            s->share_chunks(count, grain, chunk);
          },
          state,
          {},
          state->count};
}

}  // namespace
#endif

Threads::Threads(int count, double grain_flops) {
  if (count < 1) throw std::invalid_argument("Threads: count must be >= 1");
  if (!(grain_flops >= 0.0)) throw std::invalid_argument("Threads: grain_flops must be >= 0");
  state_ = std::make_unique<State>(count, grain_flops);
}

Threads::~Threads() = default;
Threads::Threads(Threads&&) noexcept = default;
Threads& Threads::operator=(Threads&&) noexcept = default;

int Threads::count() const { return state_->count; }

tree::Walker Threads::walker() const {
#ifdef BOUGH_HAS_TBB
  if (state_->count > 1) return make_walker(state_.get());
#endif
  return make_serial_walker();
}

void Threads::keep_together(const std::function<void()>& body) const {
#ifdef BOUGH_HAS_TBB
  if (state_->count > 1) return state_->started().execute(body);
#endif
  body();
}

void Threads::set_random_delay(unsigned microseconds, unsigned seed) {
  state_->delay_microseconds = microseconds;
  state_->delay_state = seed;
}

}  // namespace bough::schedule
