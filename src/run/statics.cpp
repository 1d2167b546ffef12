#include "statics.hpp"

#include "largest_load.hpp"
#include "not_judged.hpp"

namespace bough::run {

/// Adds the stability of the equilibria to the summary and, if an instability was found, the largest load.
void Statics::sum_up() {
  if (summary().status == records::RunStatus::ok) stability_.look_at_end(state_);
  summary().stability = stability_.seen();
  records::Stability& s = *summary().stability;
  if (s.unstable_directions > 0 || s.first_lost || !s.hidden.empty())
    s.largest_load = largest_load(scene_, plan_, state_.time, recording_.conservation().mass());
}

void Statics::add_doubts() {
  if (!stability_.flutter().empty()) summary().doubts.push_back({"stability", stability_.flutter()});
}

/// Branches: an equilibrium is found from the one before it, whether or not there are others under the same loads.
std::string Statics::not_judged() const {
  const std::string stability = stability_.not_examined();
  return one_line({plan_.beams.empty() || asked_.measured.mesh ? "" : the_mesh, stability,
                   summary().follows_path ? "" : "other branches of equilibria are not looked for"});
}

}  // namespace bough::run
