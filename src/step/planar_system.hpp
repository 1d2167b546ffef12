#pragma once
/// Evaluation of a scene that moves in a plane: nodes seen in it, planar elements alone and in lockstep. Internal to step.
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "lane_batches.hpp"
#include "system_parts.hpp"

namespace bough::step {

class PlanarSystem {
 public:
  PlanarSystem(const plan::Plan& plan, std::span<const solve::ElementBatch> batches,
               const std::vector<int>& joint_of_element, const HeldNodes* held)
      : plan_(plan), held_(held), joint_of_element_(joint_of_element), nodes_(plan.nodes.size()) {
    lanes_.make(plan, batches, joint_of_element, held);
    field_.nodes = nodes_.data();
  }

  std::span<const solve::ElementBatch> batches() const { return lanes_.batches(); }

  /// Nodes [begin, end) as seen in the plane.
  void set_nodes(const State& state, std::int64_t begin, std::int64_t end);
  /// What elements are evaluated at, and what a step in the plane moves.
  std::vector<elements::NodeMotionOn<motion::Se2, double>>& nodes() { return nodes_; }
  const std::vector<elements::NodeMotionOn<motion::Se2, double>>& nodes() const { return nodes_; }
  /// Gravity, laws and slopes.
  void set_field(const elements::Field& field);

  /// Residuals, magnitudes and (where wanted) tangents of all elements of a batch, as LaneBatches::evaluate.
  void evaluate(std::size_t batch, const State& state, const ElementResults& to) const {
    if (lanes_.holds(batch)) return lanes_.evaluate(batch, state, field_, to);
    for (int id : batches()[batch].element)
      if (id >= 0) place_alone(static_cast<std::size_t>(id), state, to);
  }

  /// Of one element.
  struct Counts {
    int unknowns, rows;
  };
  /// Its residual, magnitude and tangent (null: not wanted), as elements::evaluate.
  Counts evaluate_alone(std::size_t id, const State& state, double* residual, double* magnitude, double* tangent) const;

 private:
  void place_alone(std::size_t id, const State& state, const ElementResults& to) const;

  const plan::Plan& plan_;
  const HeldNodes* held_;
  const std::vector<int>& joint_of_element_;
  std::vector<elements::NodeMotionOn<motion::Se2, double>> nodes_;
  elements::FieldOn<motion::Se2, double> field_;
  LaneBatches<PlanarKernels> lanes_;
};

}  // namespace bough::step
