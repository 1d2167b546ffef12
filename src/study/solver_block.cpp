#include "bough/io/number_text.hpp"
#include "bough/scene/components.hpp"
#include "bough/study/tune.hpp"

namespace bough::study {

std::string solver_block(const scene::Solver& s) {
  static constexpr const char* libraries[] = {"klu", "sparse_lu", "umfpack", "cholmod"};
  std::string text = std::string("{\"form\": \"") + scene::to_string(s.form) + "\"";
  if (s.form == scene::SolverForm::monolithic)
    text += std::string(", \"library\": \"") + libraries[static_cast<int>(s.library)] + "\"";
  if (s.iterate_interface) text += ", \"interface_solution\": \"iterative\"";
  if (s.leaf_size > 0) text += ", \"leaf_size\": " + std::to_string(s.leaf_size);
  if (s.depth >= 0) text += ", \"depth\": " + std::to_string(s.depth);
  if (s.penalty_factor != 1.0 && s.form == scene::SolverForm::augmented) {
    text += ", \"penalty_factor\": ";
    io::append_number(text, s.penalty_factor);
  }
  return text + ", \"tasks\": " + (s.tasks ? "true" : "false") + "}";
}

}  // namespace bough::study
