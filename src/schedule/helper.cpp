#include "helper.hpp"

#ifdef __linux__
#include <sched.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <cstddef>
#include <thread>
#include <utility>

namespace bough::schedule {

namespace {

using namespace std::chrono_literals;

constexpr double share_of_time = 0.45;  // a little less than the half that the helper gets beside one other program
constexpr std::chrono::steady_clock::duration longest_burst = 500us;  // Linux lets a thread run for 0.7 to 3 ms
constexpr auto wait_awake = 50us;                                     // about what it takes to be woken up
constexpr auto longest_rest = 5ms;                                    // a hundred times wait_awake

template <class Condition>
bool spin(Condition&& is_there) {
  const auto begin = std::chrono::steady_clock::now();
  while (!is_there())
    if (std::chrono::steady_clock::now() - begin > wait_awake) return false;
  return true;
}

const tree::Subdomain& subdomain(const tree::Tree& tree, std::int64_t id) {
  return tree.subdomains[static_cast<std::size_t>(id)];
}

/// First sub-domain of the helper's half of a tree: it gets the later children of the root. Both halves are ranges,
/// since sub-domains are in postorder.
std::int64_t first_of_helper(const tree::Tree& tree) {
  const auto children = tree.children(subdomain(tree, tree.root()));
  const std::size_t mine = (children.size() + 1) / 2;
  return mine < children.size() ? subdomain(tree, children[mine]).subtree_begin : tree.root();
}

/// Visits the k-th sub-domain; on the way down k counts from below zero.
template <int direction>
void visit_one(void* visit, std::int64_t k) {
  const auto& of = *static_cast<const tree::Visit*>(visit);
  of.run(of.context, static_cast<tree::SubdomainId>(direction * k));
}

}  // namespace

/// Places the helper on any processor that it may use, except the owner's.
struct Helper::Places {
  std::thread::id owner;
#ifdef __linux__
  pid_t helper = 0;  ///< 0: the helper cannot choose its processor
  cpu_set_t usual{};
  int apart_from = -1;

  void begin() {
    apart_from = -1;
    helper = sched_getaffinity(0, sizeof usual, &usual) == 0 && CPU_COUNT(&usual) > 1 ? gettid() : 0;
  }
  void keep_apart() {
    if (helper == 0) return;
    const int mine = sched_getcpu();
    if (mine < 0 || mine == apart_from) return;
    apart_from = mine;
    cpu_set_t others = usual;
    CPU_CLR(mine, &others);
    sched_setaffinity(helper, sizeof others, &others);
  }
  void end() const {
    if (helper != 0) sched_setaffinity(0, sizeof usual, &usual);
  }
#else
  void begin() {}
  void keep_apart() {}
  void end() const {}
#endif
};

Helper::Helper() : places_(std::make_unique<Places>()) {}
Helper::~Helper() = default;

bool Helper::call() {
  if (stage_ != Stage::absent) return false;
  const std::lock_guard lock(mutex_);  // no thread serves
  places_->owner = std::this_thread::get_id();
  stage_ = Stage::called;
  return true;
}

void Helper::serve() {
  std::unique_lock lock(mutex_);
  if (stage_ != Stage::called) return;
  if (std::this_thread::get_id() == places_->owner) {
    stage_ = Stage::absent;
    return;
  }
  places_->begin();
  stage_ = Stage::ready;
  while (stage_ != Stage::dismissed) {
    const bool is_wanted =
        to_helper_.wait_for(lock, longest_rest, [&] { return stage_ == Stage::offered || stage_ == Stage::dismissed; });
    Stage stage = Stage::offered;
    if (stage_.compare_exchange_strong(stage, Stage::taken)) {
      lock.unlock();
      burst();
      lock.lock();
      stage_ = Stage::done;
      to_owner_.notify_one();
    } else if (!is_wanted && !is_sharing_ && stage_.compare_exchange_strong(stage = Stage::ready, Stage::absent)) {
      break;
    }  // otherwise the owner has taken the work back
  }
  places_->end();
}

void Helper::burst() {
  const auto begin = Clock::now();
  do {
    other_.run(other_.context, other_.begin++);
    spent_ = Clock::now() - begin;
  } while (other_.begin < other_.end && spent_ < longest_burst && !is_recalled_.load(std::memory_order_relaxed));
}

void Helper::dismiss() {
  {
    const std::lock_guard lock(mutex_);
    stage_ = Stage::dismissed;
  }
  to_helper_.notify_all();
}

void Helper::count_burst() {
  credit_ -= spent_;
  stage_ = Stage::ready;
}

void Helper::offer() {
  const Stage stage = stage_.load(std::memory_order_acquire);
  if (stage == Stage::done)
    count_burst();
  else if (stage != Stage::ready)
    return;
  if (other_.begin == other_.end) return;
  const auto now = Clock::now();
  const auto earned = share_of_time * std::chrono::duration<double>(now - std::exchange(credit_at_, now));
  credit_ = std::min(credit_ + std::chrono::duration_cast<Clock::duration>(earned), longest_burst);
  if (credit_ <= Clock::duration::zero() && !is_tireless_) return;
  is_recalled_.store(false, std::memory_order_relaxed);
  {
    const std::lock_guard lock(mutex_);
    if (stage_ != Stage::ready) return;  // the helper has just left
    places_->keep_apart();
    stage_ = Stage::offered;
  }
  to_helper_.notify_one();
}

void Helper::recall() {
  Stage stage = Stage::offered;
  if (stage_.compare_exchange_strong(stage, Stage::ready)) return;
  if (stage != Stage::taken && stage != Stage::done) return;
  is_recalled_.store(true, std::memory_order_relaxed);
  const auto is_done = [&] { return stage_.load(std::memory_order_acquire) == Stage::done; };
  if (!spin(is_done)) {
    std::unique_lock lock(mutex_);
    to_owner_.wait(lock, is_done);
  }
  count_burst();
}

void Helper::share(const Part& mine, const Part& other) {
  is_sharing_ = true;
  other_ = other;
  for (std::int64_t k = mine.begin; k < mine.end; ++k) {
    offer();
    mine.run(mine.context, k);
  }
  recall();
  while (other_.begin < other_.end) other_.run(other_.context, other_.begin++);
  is_sharing_ = false;
}

void Helper::walk_up(const tree::Tree& tree, tree::Visit visit) {
  const std::int64_t middle = first_of_helper(tree), root = tree.root();
  share({visit_one<1>, &visit, 0, middle}, {visit_one<1>, &visit, middle, root});
  visit.run(visit.context, tree.root());
}

void Helper::walk_down(const tree::Tree& tree, tree::Visit visit) {
  const std::int64_t middle = first_of_helper(tree), root = tree.root();
  visit.run(visit.context, tree.root());
  share({visit_one<-1>, &visit, 1 - middle, 1}, {visit_one<-1>, &visit, 1 - root, 1 - middle});
}

void Helper::run_chunks(std::int64_t count, std::int64_t grain, tree::Chunk chunk) {
  struct Cut {
    tree::Chunk chunk;
    std::int64_t count, grain;
  } cut{chunk, count, grain};
  const auto run = [](void* c, std::int64_t k) {
    const auto& of = *static_cast<const Cut*>(c);
    of.chunk.run(of.chunk.context, k * of.grain, std::min((k + 1) * of.grain, of.count));
  };
  const std::int64_t chunks = (count + grain - 1) / grain, middle = (chunks + 1) / 2;
  if (is_sharing_) {
    for (std::int64_t k = 0; k < chunks; ++k) run(&cut, k);
    return;
  }
  share({run, &cut, 0, middle}, {run, &cut, middle, chunks});
}

}  // namespace bough::schedule
