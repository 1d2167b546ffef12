#include "cases.hpp"

#include <algorithm>
#include <limits>

#include "../support/cpu_time.hpp"
#include "../support/matrix_file.hpp"
#include "../support/scenes.hpp"
#include "bough/schedule/serial.hpp"
#include "bough_session.hpp"
#include "trial.hpp"

namespace bough::bench {

namespace {

constexpr double slowest_first = 20.0;

const std::vector<std::string> lattice_rivals{"cholmod", "umfpack", "mumps", "superlu"};

bool contains(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

void add_bough(Field& field) {
  const Problem& p = *field.problem;
  std::shared_ptr<BoughStorage> storage;
  std::shared_ptr<solve::MatrixSolver> solver;
  const double analysis = eval_analysis([&] {
    if (!p.elements.empty())
      storage = std::make_shared<BoughStorage>(p);
    else
      solver = std::make_shared<solve::MatrixSolver>(
          schedule::make_serial_walker(), p.matrix,
          p.is_symmetric() ? solve::Symmetry::symmetric : solve::Symmetry::general);
  });
  for (int threads : {1, 2}) {
    Entrant e{.solver = "bough",
              .ordering = solver != nullptr ? solve::name_of(solver->method()) : "tree",
              .threads = threads,
              .session = nullptr,
              .backward_error = 0.0,
              .analysis = analysis,
              .first = 0.0,
              .failure = ""};
    if (solver != nullptr)
      e.session = std::make_shared<BoughMatrixSession>(p, solver, threads);
    else
      e.session = std::make_shared<BoughSession>(p, storage, threads);
    const double start = cpu_now();
    std::vector<double> x;
    bool ok = e.session->analyze() && e.session->factor();
    e.first = cpu_now() - start;
    const std::string findings = e.session->findings();
    if (!findings.empty()) e.ordering += ", " + findings;
    ok = ok && e.session->refactor_and_solve(x);
    if (ok) e.backward_error = eval_backward_error(p.matrix, x, p.rhs);
    if (!ok)
      e.failure = findings.empty() ? "fails to factor or to solve" : findings;
    else if (!(e.backward_error <= largest_backward_error))
      e.failure = describe_error(e.backward_error, e.ordering);
    field.entrants.push_back(std::move(e));
  }
}

}  // namespace

std::string Case::family_key() const {
  if (family == Family::file) return name;
  static const char* const names[] = {"chain", "star", "lat2", "lat3"};
  return std::string(names[static_cast<int>(family)]) + (values == Values::symmetric ? "_s" : "_u");
}

Problem Case::make_problem() const {
  switch (family) {
    case Family::chain:
      return bench::make_problem(name, make_chain(size), values);
    case Family::star:
      return bench::make_problem(name, make_star(size, size), values);
    case Family::lattice_2d:
      return bench::make_problem(name, make_lattice_2d(size, Support::spring), values);
    case Family::lattice_3d:
      return bench::make_problem(name, make_lattice_3d(size), values);
    case Family::file:
      break;
  }
  return bench::make_problem(file);
}

std::vector<Case> make_cases(const std::vector<std::string>& paths) {
  std::vector<Case> cases;
  for (const std::string& path : paths) {
    std::vector<std::filesystem::path> files;
    if (std::filesystem::is_directory(path)) {
      for (const auto& entry : std::filesystem::directory_iterator(path))
        if (entry.path().extension() == ".mtx") files.push_back(entry.path());
      std::sort(files.begin(), files.end());
    } else {
      files.emplace_back(path);
    }
    for (const std::filesystem::path& file : files)
      cases.push_back({.name = file.stem().string(),
                       .family = Family::file,
                       .size = 0,
                       .values = Values::unsymmetric,
                       .bar = 0.0,
                       .rivals = {},
                       .file = file});
  }
  return cases;
}

std::vector<Case> make_cases() {
  std::vector<Case> cases;
  for (Values values : {Values::unsymmetric, Values::symmetric}) {
    const bool is_u = values == Values::unsymmetric;
    const std::string end = is_u ? "_u" : "_s";
    const std::vector<std::string> rival{is_u ? "klu" : "eigen_ldlt"};
    for (int n : {32, 128, 512, 2048, 8192}) {
      const double bar = !is_u || n == 32 ? 5.0 : n == 8192 ? 6.0 : 8.0;
      cases.push_back({"chain_" + std::to_string(n) + end, Family::chain, n, values, bar, rival, {}});
    }
    cases.push_back({"star_64" + end, Family::star, 64, values, is_u ? 8.0 : 5.0, rival, {}});
    for (int n : {20, 50, 100, 150})
      cases.push_back({"lat2_" + std::to_string(n) + end, Family::lattice_2d, n, values, 1.5, lattice_rivals, {}});
    for (int n : {8, 12, 16})
      cases.push_back({"lat3_" + std::to_string(n) + end, Family::lattice_3d, n, values, 1.2, lattice_rivals, {}});
  }
  return cases;
}

Memory::Item& Memory::of(const std::string& key) {
  for (Item& i : items)
    if (i.key == key) return i;
  items.push_back({key, "", false, ""});
  return items.back();
}

Field make_field(const Case& bench_case, const std::vector<Peer>& peers, bool has_bough, Memory& memory,
                 std::vector<LeftOut>& left_out) {
  Field field;
  field.bench_case = &bench_case;
  field.problem = std::make_unique<Problem>(bench_case.make_problem());
  const Problem& p = *field.problem;
  std::vector<Trial> trials;
  double best_rival = std::numeric_limits<double>::infinity();
  for (const bool rivals_turn : {true, false}) {
    for (const Peer& peer : peers) {
      if (contains(bench_case.rivals, peer.name) != rivals_turn) continue;
      Memory::Item& kept = memory.of(peer.name + "/" + bench_case.family_key());
      if (peer.orderings(p).empty()) {
        left_out.push_back({peer.name, bench_case.name, "for symmetric matrices only"});
        continue;
      }
      if (kept.is_out) {
        left_out.push_back({peer.name, bench_case.name, kept.reason});
        continue;
      }
      const double limit = rivals_turn || bench_case.rivals.empty() ? std::numeric_limits<double>::infinity()
                                                                    : slowest_first * best_rival / bench_case.bar;
      Trial t = try_peer(peer, p, kept.ordering, limit);
      kept.ordering = t.ordering;
      if (!t.failure.empty()) {
        left_out.push_back({peer.name, bench_case.name, t.failure});
        kept.is_out = t.is_slow;
        kept.reason = "left out of " + bench_case.name + " for its time already";
        continue;
      }
      if (rivals_turn) best_rival = std::min(best_rival, t.again);
      trials.push_back(std::move(t));
    }
  }
  for (Trial& t : trials) {
    Entrant e{.solver = t.peer->name,
              .ordering = t.ordering,
              .threads = 1,
              .session = std::move(t.session),
              .backward_error = t.backward_error,
              .analysis = t.analysis,
              .first = t.first,
              .failure = ""};
    if (t.peer->uses_blas) {
      field.entrants.push_back(e);
      field.entrants.back().threads = 2;
    }
    field.entrants.push_back(std::move(e));
  }
  if (has_bough) add_bough(field);
  return field;
}

}  // namespace bough::bench
