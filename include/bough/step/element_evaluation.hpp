#pragma once
/// Evaluation of all elements at a state: residuals and tangents, and the matrices that the solver gets from them.
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "bough/step/instant.hpp"
#include "bough/step/linear_solution.hpp"
#include "bough/step/residual_sums.hpp"
#include "bough/step/unknown_places.hpp"

namespace bough::step {

template <class G>
class LaneBatches;
class TrimmedElements;
struct ElementResults;

/// Lengths by which relative changes of elements and moments are judged.
struct ElementLengths {
  std::vector<double> of_element;  ///< of the reference axis, where an element has one, else Plan::length_scale [m]
  /// Arm that turns the scale of forces into one of moments: the longest reference axis, or Plan::length_scale [m].
  double moment_arm = 0.0;
};
ElementLengths measure_elements(const plan::Plan& plan);

class ElementEvaluation {
 public:
  /// trimmed: may be null. Residuals go to `sums`, tangents to the storage of the solver of `linear`.
  ElementEvaluation(const plan::Plan& plan, const Instant& instant, const TrimmedElements* trimmed, ResidualSums& sums,
                    LinearSolution& linear, const tree::Walker& walker);
  ~ElementEvaluation();

  /// To be called when the frames of prescribed motion of the instant have moved.
  void take_frames();
  /// Begins the evaluation of all elements on the group of the scene at a state, which must stay as it is until they
  /// are evaluated.
  void begin(const State& state, const elements::Slopes& slopes, bool tangent);
  /// Evaluates the elements of a visit of the solver's walks, writes their parts and, if so begun, their tangents. Some
  /// are evaluated with elements of a visit below, where all lanes are needed. Several threads may do so.
  void evaluate_visit(int visit);
  /// Writes the parts of elements evaluated in space, as sensors see them, taken to the unknowns of a reduced model;
  /// without magnitudes. Nodes keep other digits there than they have in space, so these elements respond with other
  /// forces.
  void evaluate_as_seen(const State& state);

  /// Puts an element's matrix, row-major in all of its unknowns, in the place of its tangent, or adds it there. Several
  /// threads may do so for different elements. LinearSolution::begin_matrices has to be called before.
  void set_matrix(int element, int num_unknowns, const double* entries);
  void add_matrix(int element, int num_unknowns, const double* entries);
  /// An element's matrix now present, row-major, and the unknowns of its rows.
  solve::ConstElementView matrix_of(int element, std::vector<std::int64_t>& unknowns) const;

 private:
  template <class G>
  void evaluate_batches(const elements::FieldOn<G, double>& field, std::int64_t begin, std::int64_t end);
  template <class G>
  void evaluate_alone(std::size_t id, const State& state, const elements::FieldOn<G, double>& field,
                      const ElementResults& to);
  /// Puts (A + A^T) / 2 in place of the tangents of a batch.
  void symmetrise(const solve::ElementBatch& batch);

  const plan::Plan& plan_;
  const Instant& instant_;
  const TrimmedElements* trimmed_;
  ResidualSums& sums_;
  LinearSolution& linear_;
  tree::Walker walker_;
  template <class G>
  using LanesOn = std::unique_ptr<LaneBatches<G>>;
  motion::Groups::OneOf<LanesOn> lanes_;  ///< on the group of the scene
  // Of the present evaluation.
  template <class G>
  using FieldOf = elements::FieldOn<G, double>;
  motion::Groups::OneOf<FieldOf> field_;
  const State* state_ = nullptr;
  bool with_tangents_ = false;
};

}  // namespace bough::step
