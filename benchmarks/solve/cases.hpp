#pragma once
/// The cases of the solver benchmark, the ratios required, and the solvers that take part in each.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "../support/problem.hpp"
#include "peer.hpp"

namespace bough::bench {

enum class Family { chain, star, lattice_2d, lattice_3d, file };

struct Case {
  std::string name;  ///< "chain_128_u"
  Family family;
  int size;
  Values values;
  double bar;                       ///< least required ratio of the best of `rivals` to bough
  std::vector<std::string> rivals;  ///< solvers that the bar was set for
  std::filesystem::path file;       ///< of the matrix, if it is not of a scene
  std::string family_key() const;   ///< "chain_u"; of a file its name
  Problem make_problem() const;
};

std::vector<Case> make_cases();
/// The cases of Matrix Market files, and of all files *.mtx in folders, by name.
std::vector<Case> make_cases(const std::vector<std::string>& paths);

/// A solver that takes part in a case.
struct Entrant {
  std::string solver;
  std::string ordering;
  int threads = 1;
  std::shared_ptr<Session> session;
  double backward_error = 0.0, analysis = 0.0, first = 0.0;  ///< CPU seconds of analysis and first factorization
  std::string failure;                                       ///< of bough; empty: none
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

/// Makes the problem, tries the peers' orderings, checks every solution, and excludes:
///   - a solver that does not apply, that fails, or whose backward error is above 1e-10;
///   - a solver that is not among the rivals and whose first numeric factorization takes more than 20 times (best
///     rival's refactorization and solution) / bar, here or in a smaller case of the family.
/// Orderings are compared while the first factorization takes less than 0.3 s; larger cases use the choice of the next
/// smaller one. Peers whose BLAS has threads take part with one and with two. has_bough: rows of bough with one thread
/// and with two, also if it fails.
Field make_field(const Case& bench_case, const std::vector<Peer>& peers, bool has_bough, Memory& memory,
                 std::vector<LeftOut>& left_out);

}  // namespace bough::bench
