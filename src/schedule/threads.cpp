#include "bough/schedule/threads.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "bough/blocks/at.hpp"
#include "bough/schedule/serial.hpp"
#ifdef BOUGH_HAS_TBB
#include <tbb/task_group.h>

#include "arena.hpp"
#endif

namespace bough::schedule {

#ifdef BOUGH_HAS_TBB
namespace {

using Clock = std::chrono::steady_clock;

/// A thread that waits looks again after some ten nanoseconds at first, and lets other programs have its processor
/// after `most_alone`. A helper stays for `most_awake`: between the walks of a step some 10 to 1000 microseconds pass,
/// and a thread that sleeps takes 50 of them to wake, or thousands on a virtual machine.
constexpr auto most_alone = std::chrono::microseconds(50);
constexpr auto most_awake = std::chrono::microseconds(2000);

class Wait {
 public:
  /// Passes some time. Returns whether a helper should stay.
  bool pause() {
#if defined(__x86_64__)
    for (int k = 0; k < 8; ++k) __builtin_ia32_pause();
#endif
    const auto waited = Clock::now() - since_;
    if (waited > most_alone) std::this_thread::yield();
    return waited < most_awake;
  }

 private:
  Clock::time_point since_ = Clock::now();
};

/// The first exception that a part of a job throws. The parts after it are left out.
class Failure {
 public:
  template <class Part>
  void run(Part&& part) {
    if (has_failed_.load(std::memory_order_relaxed)) return;
    try {
      part();
    } catch (...) {
      if (!has_failed_.exchange(true)) thrown_ = std::current_exception();
    }
  }
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  std::atomic<bool> has_failed_{false};
  std::exception_ptr thrown_;
};

/// A list cut into consecutive shares, one for each thread or group of threads. A thread takes from its own share
/// first, so that the same data mostly stay with one processor from walk to walk, and from the others' when that is
/// empty.
class Shares {
 public:
  explicit Shares(int members) : count_(std::min(members, most)) {}
  int count() const { return count_; }
  void set(int share, std::int64_t begin, std::int64_t end) {
    shares_[at(share)].next.store(begin, std::memory_order_relaxed);
    shares_[at(share)].end = end;
  }
  /// Index of an entry that nobody has taken; -1: none is left.
  std::int64_t take(int member) {
    for (int k = 0; k < count_; ++k) {
      Share& share = shares_[at((member + k) % count_)];
      if (share.next.load(std::memory_order_relaxed) >= share.end) continue;
      if (const std::int64_t i = share.next.fetch_add(1, std::memory_order_relaxed); i < share.end) return i;
    }
    return -1;
  }

 private:
  static constexpr int most = 16;
  struct alignas(64) Share {
    std::atomic<std::int64_t> next{0};
    std::int64_t end = 0;
  };
  int count_;
  std::array<Share, most> shares_;
};

/// Work that a thread shares out to those that have none.
class Offer {
 public:
  bool is_open() const { return job_.load(std::memory_order_acquire) != nullptr; }

  /// Runs `job(member)`, which takes part after part until none is left and does not throw, on this thread and on those
  /// that come to help. `call` is called once they may come, `meanwhile` again and again while they finish their parts.
  template <class Job, class Call, class Meanwhile>
  void share(Job& job, int member, Call call, Meanwhile meanwhile) {
    run_ = [](void* of, int helper) { (*static_cast<Job*>(of))(helper); };
    job_.store(&job);
    call();
    job(member);
    job_.store(nullptr);
    for (Wait wait; helpers_.load() > 0;)
      if (!meanwhile()) wait.pause();
  }
  /// Takes part in the job. False: there is none.
  bool help(int member) {
    if (!is_open()) return false;
    helpers_.fetch_add(1);  // before the job is read, so that its owner stays
    void* const job = job_.load();
    if (job != nullptr) run_(job, member);
    helpers_.fetch_sub(1);
    return job != nullptr;
  }

 private:
  alignas(64) std::atomic<void*> job_{nullptr};
  void (*run_)(void* job, int member) = nullptr;  ///< written while no job is open
  std::atomic<int> helpers_{0};
};

}  // namespace
#endif

struct Threads::State {
  State(int n, double grain)
      : count(n),
        grain_flops(grain)
#ifdef BOUGH_HAS_TBB
        ,
        shares(n),
        loops(at(n))
#endif
  {
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  int count;
  double grain_flops;
  std::atomic<unsigned> delay_microseconds{0};
  std::atomic<unsigned> delay_state{1};

#ifdef BOUGH_HAS_TBB
  /// A sub-domain above the grain, or a whole subtree below it.
  struct Part {
    tree::SubdomainId top = 0;
    int parent = -1;  ///< in parts
    bool is_whole = false;
    std::atomic<int> open_children{0};
    std::atomic<bool> is_taken{false}, is_done{false};
  };

  Arena arena{count};

  bool is_together = false;
  std::atomic<bool> is_ending{false};
  std::optional<tbb::task_group> helpers;  ///< while threads are kept together
  std::atomic<int> num_helpers{0};         ///< tasks that help, or soon will

  std::unique_ptr<Part[]> parts;  ///< of the present walk, parents first
  int num_parts = 0, room = 0;
  std::vector<int> wholes;  ///< parts that are whole, in postorder
  Shares shares;            ///< of `wholes`
  Offer walks;
  std::vector<Offer> loops;  ///< by member: of a visit, or outside of walks

  /// Runs `body` in the arena. From its first walk or loop on, tasks keep the other threads at hand.
  template <class Body>
  void keep_together(const Body& body) {
    if (is_together) return body();
    arena.started().execute([&] {
      struct End {
        State& state;
        ~End() {
          state.is_ending = true;
          state.helpers->wait();
          state.is_together = false;
        }
      };
      helpers.emplace();
      const End end{*this};
      is_together = true;
      is_ending = false;
      body();
    });
  }

  static int member() { return std::max(tbb::this_task_arena::current_thread_index(), 0); }

  void call_helpers() {
    while (num_helpers.load() < count - 1) {
      ++num_helpers;
      helpers->run([this] { help_for_a_while(); });
    }
  }
  void help_for_a_while() {
    const int self = member();
    for (Wait wait; !is_ending.load(std::memory_order_acquire);) {
      if (walks.help(self) || help_in_loops(self))
        wait = Wait();
      else if (!wait.pause())
        break;
    }
    --num_helpers;
  }
  bool help_in_loops(int self) {
    bool has_helped = false;
    for (Offer& loop : loops) has_helped = loop.help(self) || has_helped;
    return has_helped;
  }

  [[nodiscard]] bool is_whole(const tree::Subdomain& s) const { return s.is_leaf() || s.subtree_flops < grain_flops; }

  void delay() {
    const unsigned limit = delay_microseconds.load(std::memory_order_relaxed);
    if (limit == 0) return;
    unsigned r = delay_state.fetch_add(0x9e3779b9u, std::memory_order_relaxed);
    r ^= r >> 16;
    r *= 0x7feb352du;
    r ^= r >> 15;
    const auto until = Clock::now() + std::chrono::microseconds(r % limit);
    while (Clock::now() < until) {
    }
  }

  void walk(const tree::Tree& tree, tree::Visit visit, bool is_upward) {
    if (is_whole(tree.subdomains[at(tree.root())])) return visit_whole(tree, tree.root(), visit, is_upward);
    if (!is_together) return keep_together([&] { walk(tree, visit, is_upward); });
    divide(tree);
    Failure failure;
    const auto run = [&](const Part& part) {
      failure.run([&] {
        delay();
        if (part.is_whole)
          visit_whole(tree, part.top, visit, is_upward);
        else
          visit.run(visit.context, part.top);
      });
    };
    auto job = [&](int self) {
      for (std::int64_t i; (i = shares.take(self)) >= 0;) {
        if (is_upward)
          run_and_climb(wholes[at(i)], run);
        else
          run_below(wholes[at(i)], run);
      }
    };
    const int self = member();
    walks.share(
        job, self, [this] { call_helpers(); }, [this, self] { return help_in_loops(self); });
    failure.rethrow();
  }

  static void visit_whole(const tree::Tree& tree, tree::SubdomainId top, tree::Visit visit, bool is_upward) {
    const tree::SubdomainId bottom = tree.subdomains[at(top)].subtree_begin;
    if (is_upward)
      for (tree::SubdomainId s = bottom; s <= top; ++s) visit.run(visit.context, s);
    else
      for (tree::SubdomainId s = top; s >= bottom; --s) visit.run(visit.context, s);
  }

  /// Runs a part, and those above it of which it is the last below.
  template <class Run>
  void run_and_climb(int p, const Run& run) {
    run(parts[at(p)]);
    for (p = parts[at(p)].parent; p >= 0 && parts[at(p)].open_children.fetch_sub(1) == 1; p = parts[at(p)].parent)
      run(parts[at(p)]);
  }

  /// Runs a part after those above it. Whoever has taken one of these is at work on it or waits for one further up, so
  /// that a thread can wait for it.
  template <class Run>
  void run_below(int p, const Run& run) {
    Part& part = parts[at(p)];
    if (part.is_done.load(std::memory_order_acquire)) return;
    if (part.parent >= 0) run_below(part.parent, run);
    if (!part.is_taken.exchange(true)) {
      run(part);
      part.is_done.store(true, std::memory_order_release);
      return;
    }
    for (Wait wait; !part.is_done.load(std::memory_order_acquire);)
      if (!help_in_loops(member())) wait.pause();
  }

  /// Cuts the tree into parts, and the whole ones of them into shares of equal work.
  void divide(const tree::Tree& tree) {
    if (room < tree.num_subdomains()) {
      room = tree.num_subdomains();
      parts.reset(new Part[at(room)]);
      wholes.reserve(at(room));
    }
    num_parts = 0;
    wholes.clear();
    add_part(tree, tree.root(), -1);
    double work = 0.0, all = 0.0;
    for (const int p : wholes) all += tree.subdomains[at(parts[at(p)].top)].subtree_flops;
    std::size_t end = 0;
    for (int share = 0; share < shares.count(); ++share) {
      const std::size_t begin = end;
      const double up_to = all * (share + 1) / shares.count();
      for (; end < wholes.size() && (work < up_to || share + 1 == shares.count()); ++end)
        work += tree.subdomains[at(parts[at(wholes[end])].top)].subtree_flops;
      shares.set(share, static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end));
    }
  }

  void add_part(const tree::Tree& tree, tree::SubdomainId top, int parent) {
    const tree::Subdomain& s = tree.subdomains[at(top)];
    const int self = num_parts++;
    Part& part = parts[at(self)];
    part.top = top;
    part.parent = parent;
    part.is_whole = is_whole(s);
    part.open_children = part.is_whole ? 0 : static_cast<int>(tree.children(s).size());
    part.is_taken = part.is_done = false;
    if (part.is_whole) {
      wholes.push_back(self);
      return;
    }
    for (const tree::SubdomainId child : tree.children(s)) add_part(tree, child, self);
  }

  void run_chunks(std::int64_t count_items, std::int64_t grain, tree::Chunk chunk) {
    const std::int64_t chunks = (count_items + grain - 1) / grain;
    Failure failure;
    Shares of_chunks(count);
    for (int k = 0; k < of_chunks.count(); ++k)
      of_chunks.set(k, chunks * k / of_chunks.count(), chunks * (k + 1) / of_chunks.count());
    auto job = [&](int self) {
      for (std::int64_t c; (c = of_chunks.take(self)) >= 0;)
        failure.run([&] {
          delay();
          chunk.run(chunk.context, c * grain, std::min((c + 1) * grain, count_items));
        });
    };
    const int self = member();
    if (Offer& loop = loops[at(self)]; loop.is_open())
      job(self);  // inside a chunk of another loop
    else
      loop.share(
          job, self, [this] { call_helpers(); }, [] { return false; });
    failure.rethrow();
  }

  void each(std::int64_t count_items, std::int64_t grain, tree::Chunk chunk) {
    if (count_items <= grain) {
      if (count_items > 0) chunk.run(chunk.context, 0, count_items);
    } else if (is_together) {
      run_chunks(count_items, grain, chunk);
    } else {
      keep_together([&] { run_chunks(count_items, grain, chunk); });
    }
  }
#endif
};

#ifdef BOUGH_HAS_TBB
namespace {

template <class State>
tree::Walker make_walker(State* state) {
  return {[](void* context, const tree::Tree& tree, tree::Visit visit) {
            static_cast<State*>(context)->walk(tree, visit, true);
          },
          [](void* context, const tree::Tree& tree, tree::Visit visit) {
            static_cast<State*>(context)->walk(tree, visit, false);
          },
          [](void* context, std::int64_t count, std::int64_t grain, tree::Chunk chunk) {
            static_cast<State*>(context)->each(count, grain, chunk);
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
  if (state_->count > 1) return state_->keep_together(body);
#endif
  body();
}

void Threads::set_random_delay(unsigned microseconds, unsigned seed) {
  state_->delay_microseconds = microseconds;
  state_->delay_state = seed;
}

}  // namespace bough::schedule
