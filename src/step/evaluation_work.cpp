#include "evaluation_work.hpp"

#include <algorithm>
#include <type_traits>

#include "bough/elements/evaluate_lanes.hpp"
#include "bough/plan/elements_of.hpp"
#include "bough/solve/element_view.hpp"
#include "element_parts.hpp"

namespace bough::step {

namespace {

template <class G>
bool may_share(const plan::Plan& plan, std::size_t a, std::size_t b) {
  const plan::ElementPlace one = plan.directory[a], other = plan.directory[b];
  if (one.array != other.array) return false;
  bool may = false;
  plan::with_element(plan::arrays_on<G>(plan), one, [&](const auto& x) {
    plan::with_element(plan::arrays_on<G>(plan), other, [&](const auto& y) {
      if constexpr (std::is_same_v<decltype(x), decltype(y)>) may = may_share_lanes(x, y);
    });
  });
  return may;
}

template <class G>
std::vector<EvaluationWork> count_on(const plan::Plan& plan) {
  constexpr std::size_t most_kinds = 64;  // that are told apart; elements of others are taken to be evaluated alone
  std::vector<EvaluationWork> kinds;
  for (std::size_t e = 0; e < plan.directory.size(); ++e) {
    if (plan.graph.element_begin[e] == plan.graph.element_begin[e + 1]) continue;
    if (is_idle_joint(plan, plan.joint_of_element[e])) continue;
    const bool reads_signals = !plan::signals_of(plan, e).empty();
    auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const EvaluationWork& k) {
      return reads_signals ? plan.directory[k.first].array == plan.directory[e].array : may_share<G>(plan, k.first, e);
    });
    const bool is_alone = reads_signals || (kind == kinds.end() && kinds.size() >= most_kinds);
    if (kind == kinds.end()) kind = kinds.insert(kinds.end(), {.first = e});
    ++kind->elements;
    kind->alone += is_alone ? 1 : 0;
  }
  for (EvaluationWork& k : kinds) {
    const int sharing = k.elements - k.alone, rest = sharing % solve::lanes_wide;
    k.packs = sharing / solve::lanes_wide + (rest >= least_lanes ? 1 : 0);
    k.alone += rest < least_lanes ? rest : 0;
  }
  return kinds;
}

}  // namespace

std::vector<EvaluationWork> count_evaluations(const plan::Plan& plan) {
  return plan.with_group([&]<class G>() { return count_on<G>(plan); });
}

}  // namespace bough::step
