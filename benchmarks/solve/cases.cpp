#include "cases.hpp"

#include <algorithm>
#include <limits>

#include "../support/scenes.hpp"
#include "bough_session.hpp"
#include "trial.hpp"

namespace bough::bench {

namespace {

constexpr double slowest_first = 20.0;

const std::vector<std::string> lattice_rivals{"cholmod", "umfpack", "mumps", "superlu"};

bool contains(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

void add_bough(Field& field, bool lockstep, const std::vector<int>& thread_counts, std::vector<LeftOut>& left_out) {
  if (thread_counts.empty()) return;
  const std::string name = lockstep ? "bough_lockstep" : "bough";
  const auto storage = std::make_shared<BoughStorage>(*field.problem, lockstep);
  for (int threads : thread_counts) {
    Entrant e{name, "tree", threads, std::make_unique<BoughSession>(*field.problem, storage, threads)};
    std::vector<double> x;
    const bool ok = e.session->analyze() && e.session->factor() && e.session->refactor_and_solve(x);
    e.backward_error = ok ? eval_backward_error(field.problem->matrix, x, field.problem->rhs) : 0.0;
    if (ok && e.backward_error <= largest_backward_error)
      field.entrants.push_back(std::move(e));
    else
      left_out.push_back({name, field.bench_case->name,
                          ok ? describe_error(e.backward_error, "tree") : "fails to factor or to solve"});
  }
}

}  // namespace

std::string Case::family_key() const {
  static const char* const names[] = {"chain", "star", "lat2", "lat3"};
  return std::string(names[static_cast<int>(family)]) + (values == Values::symmetric ? "_s" : "_u");
}

scene::Scene Case::make_scene() const {
  switch (family) {
    case Family::chain:
      return make_chain(size);
    case Family::star:
      return make_star(size, size);
    case Family::lattice_2d:
      return make_lattice_2d(size, Support::spring);
    case Family::lattice_3d:
      break;
  }
  return make_lattice_3d(size);
}

std::vector<Case> make_cases() {
  std::vector<Case> cases;
  for (Values values : {Values::unsymmetric, Values::symmetric}) {
    const bool is_u = values == Values::unsymmetric;
    const std::string end = is_u ? "_u" : "_s";
    const std::vector<std::string> rival{is_u ? "klu" : "eigen_ldlt"};
    for (int n : {32, 128, 512, 2048, 8192}) {
      const double bar = !is_u || n == 32 ? 5.0 : n == 8192 ? 6.0 : 8.0;
      cases.push_back({"chain_" + std::to_string(n) + end, Family::chain, n, values, bar, rival});
    }
    cases.push_back({"star_64" + end, Family::star, 64, values, is_u ? 8.0 : 5.0, rival});
    for (int n : {20, 50, 100, 150})
      cases.push_back({"lat2_" + std::to_string(n) + end, Family::lattice_2d, n, values, 1.5, lattice_rivals});
    for (int n : {8, 12, 16})
      cases.push_back({"lat3_" + std::to_string(n) + end, Family::lattice_3d, n, values, 1.2, lattice_rivals});
  }
  return cases;
}

Memory::Item& Memory::of(const std::string& key) {
  for (Item& i : items)
    if (i.key == key) return i;
  items.push_back({key, "", false, ""});
  return items.back();
}

Field make_field(const Case& bench_case, const std::vector<Peer>& peers, const OwnRows& own, Memory& memory,
                 std::vector<LeftOut>& left_out) {
  Field field;
  field.bench_case = &bench_case;
  field.problem = std::make_unique<Problem>(make_problem(bench_case.name, bench_case.make_scene(), bench_case.values));
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
      const double limit =
          rivals_turn ? std::numeric_limits<double>::infinity() : slowest_first * best_rival / bench_case.bar;
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
  for (Trial& t : trials)
    field.entrants.push_back({t.peer->name, t.ordering, 1, std::move(t.session), t.backward_error});
  add_bough(field, false, own.thread_counts, left_out);
  if (own.lockstep && bench_case.family == Family::chain && !p.is_symmetric())
    add_bough(field, true, own.thread_counts, left_out);
  return field;
}

}  // namespace bough::bench
