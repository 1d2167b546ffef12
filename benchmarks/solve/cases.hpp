#pragma once
/// The cases of the solver benchmark, the ratios required, and the solvers that take part in each.
#include <memory>
#include <string>
#include <vector>

#include "../support/problem.hpp"
#include "peer.hpp"

namespace bough::bench {

enum class Family { chain, star, lattice_2d, lattice_3d };

struct Case {
  std::string name;  ///< "chain_128_u"
  Family family;
  int size;
  Values values;
  double bar;                       ///< least required ratio of the best of `rivals` to bough
  std::vector<std::string> rivals;  ///< solvers that the ratio refers to
  std::string family_key() const;   ///< "chain_u"
  scene::Scene make_scene() const;
};

std::vector<Case> make_cases();

/// A solver that takes part in a case.
struct Entrant {
  std::string solver;
  std::string ordering;
  int threads = 1;
  std::unique_ptr<Session> session;
  double backward_error = 0.0;
};

/// A solver that does not.
struct LeftOut {
  std::string solver, case_name, reason;
};

struct Field {
  const Case* bench_case = nullptr;
  std::unique_ptr<Problem> problem;
  std::vector<Entrant> entrants;
};

/// Data passed from case to case of a family; cases are in order of size.
struct Memory {
  struct Item {
    std::string key;  ///< "klu/chain_u"
    std::string ordering;
    bool is_out = false;
    std::string reason;
  };
  std::vector<Item> items;
  Item& of(const std::string& key);
};

/// Rows of bough itself.
struct OwnRows {
  std::vector<int> thread_counts;  ///< empty: none
  /// Adds rows `bough_lockstep` of unsymmetric chains, with the tree for several solutions per factorization.
  bool lockstep = false;
};

/// Makes the problem, tries the peers' orderings, checks every solution, and excludes:
///   - a solver that does not apply, that fails, or whose backward error is above 1e-10;
///   - a solver that is not among the rivals and whose first numeric factorization takes more than 20 times (best
///     rival's refactorization and solution) / bar, here or in a smaller case of the family.
/// Orderings are compared while the first factorization takes less than 0.3 s; larger cases use the choice of the next
/// smaller one.
Field make_field(const Case& bench_case, const std::vector<Peer>& peers, const OwnRows& own, Memory& memory,
                 std::vector<LeftOut>& left_out);

}  // namespace bough::bench
