#pragma once
/// The solver's interface to scheduling: function pointers that visit every sub-domain, children first or parents
/// first.
#include <cstdint>

#include "bough/tree/tree.hpp"

namespace bough::tree {

/// The purpose of a walk, for timing. It does not affect how a walk is done.
enum class Work : std::uint8_t { other, evaluate, factor, forward, backward, residual };

/// Part of one visit.
enum class Stage : std::uint8_t { evaluate, assemble, eliminate, forward, substitute };

/// Called by a visit at the end of a stage; does nothing unless the walk is timed.
struct Mark {
  void (*run)(void* context, Stage done) = nullptr;
  void* context = nullptr;
  void operator()(Stage done) const {
    if (run != nullptr) run(context, done);
  }
};

/// Work on one sub-domain (its own fronts). An exception ends the walk and reaches its caller.
struct Visit {
  void (*run)(void* context, SubdomainId subdomain) = nullptr;
  void* context = nullptr;
  Work work = Work::other;
};

/// Work on a chunk [begin, end) of independent items. An exception ends the loop and reaches its caller.
struct Chunk {
  void (*run)(void* context, std::int64_t begin, std::int64_t end) = nullptr;
  void* context = nullptr;
  Work work = Work::other;
  int parts = 1;  ///< into which the caller would cut an item for several threads: for timings
};

/// The three ways to walk a tree. `up` visits every child before its parent, `down` every parent before its children.
/// `each` divides [0, count) into chunks of `grain` items (the last may be shorter; the division does not depend on the
/// number of threads), and may be called inside visits. All return when the walk is complete.
struct Walker {
  void (*up)(void* context, const Tree& tree, Visit visit) = nullptr;
  void (*down)(void* context, const Tree& tree, Visit visit) = nullptr;
  void (*each)(void* context, std::int64_t count, std::int64_t grain, Chunk chunk) = nullptr;
  void* context = nullptr;
  Mark mark = {};   ///< for visits that time their stages
  int threads = 1;  ///< largest number of threads that may visit at the same time

  void walk_up(const Tree& tree, Visit visit) const { up(context, tree, visit); }
  void walk_down(const Tree& tree, Visit visit) const { down(context, tree, visit); }
  void for_each_chunk(std::int64_t count, std::int64_t grain, Chunk chunk) const { each(context, count, grain, chunk); }
};

/// A visit that calls `body(SubdomainId)`; body must outlive the walk.
template <class Body>
Visit make_visit(Body& body, Work work = Work::other) {
  return {[](void* context, SubdomainId s) { (*static_cast<Body*>(context))(s); }, &body, work};
}

/// A chunk that calls `body(begin, end)`; body must outlive the call.
template <class Body>
Chunk make_chunk(Body& body, Work work = Work::other, int parts = 1) {
  return {[](void* context, std::int64_t begin, std::int64_t end) { (*static_cast<Body*>(context))(begin, end); },
          &body, work, parts};
}

}  // namespace bough::tree
