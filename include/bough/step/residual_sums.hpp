#pragma once
/// Sums of what elements contribute to the residual, by node and by joint, and the sizes of these sums.
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bough/step/linear_solution.hpp"
#include "bough/step/unknown_places.hpp"
#include "bough/step/visit_ranges.hpp"

namespace bough::step {

class TrimmedElements;

/// Largest entries of a residual: forces, moments, and violations of constraints of lengths and of angles.
struct ResidualSize {
  double force = 0.0, moment = 0.0;              ///< |sum of contributions|
  double force_scale = 0.0, moment_scale = 0.0;  ///< largest sum of |contributions| at a node
  double length = 0.0, angle = 0.0;              ///< constraint violations
  double signal = 0.0;                           ///< of equations of signals, relative to their terms [-]
  int worst_force_node = -1, worst_moment_node = -1, worst_joint = -1, worst_signal = -1;
};

/// Each element writes its contributions, and the magnitudes of their terms, to a place of its own, its *parts*. The
/// parts are added up in a fixed order, so that sums do not depend on the number of threads.
class ResidualSums {
 public:
  /// trimmed: may be null.
  ResidualSums(const plan::Plan& plan, const UnknownPlaces& places, const LinearSolution& linear,
               const TrimmedElements* trimmed);

  /// The parts of element e begin at 2 begins()[e]: for each of its nodes, then for its rows, the entries of the
  /// residual followed by the magnitudes of these entries.
  double* parts() { return parts_.data(); }
  const std::int64_t* begins() const { return element_begin_.data(); }
  /// Sets the parts of an element. magnitude: null for zeros.
  void set_parts(std::size_t element, const double* residual, const double* magnitude);

  /// Sets the residual of the equation of a signal, whose terms have this size in all. To be cleared before.
  void clear_signals();
  void set_signal(int signal, std::size_t unknown, double residual, double size_of_terms);

  /// Adds up what elements have contributed to the blocks whose unknowns a visit of the solver's walks eliminates. All
  /// of these are elements of this visit and of those below it.
  void sum_visit(int visit, const tree::Walker& walker);
  /// Adds up the forces on held nodes, which have no unknowns. To be called after all visits.
  void sum_held();
  /// Minus the residual, by unknown.
  const std::vector<double>& right_hand_side() const { return right_hand_side_; }
  /// Without the worst nodes and joint, which name_worst finds, for messages.
  ResidualSize size() const;
  void name_worst(ResidualSize& size) const;
  bool is_finite() const;
  /// A signal whose equation is not finite; -1: none.
  int lost_signal() const { return lost_signal_; }
  /// The first element with a part that is not finite.
  std::optional<std::size_t> first_not_finite() const;

 private:
  /// A sum of parts: of a block or, after all blocks, of the forces on a held node.
  struct Sum {
    std::int64_t use_begin, use_end;  ///< range in uses_
    std::int64_t unknown;             ///< the first
    int size;
    int owner;  ///< node or joint
  };
  struct ChunkSize {
    ResidualSize size;
    bool is_finite;
  };

  /// Sums of one visit, or of held nodes: nodes, then points, then joints.
  struct Chunk {
    std::size_t begin, nodes_end, points_end, end;
  };

  void place_parts(const LinearSolution& linear, const TrimmedElements* trimmed);
  void add_chunks(std::size_t begin, std::size_t nodes, std::size_t points);
  template <int Count>
  ChunkSize sum_nodes(std::size_t begin, std::size_t end);
  void copy_rows(std::size_t begin, std::size_t end, ChunkSize& chunk);
  std::array<double, 12> add_up(const Sum& sum) const;
  void sum_point(const Sum& sum, ChunkSize& chunk);
  void sum_held_node(const Sum& sum, ChunkSize& chunk) const;
  void sum_chunk(std::size_t chunk);

  const plan::Plan& plan_;
  const UnknownPlaces& places_;
  std::vector<std::int64_t> element_begin_;  ///< by element: number of unknowns of all elements before it
  std::vector<double> parts_;
  std::vector<Sum> sums_;  ///< visit after visit, then held nodes
  std::vector<Chunk> chunks_;
  VisitRanges chunks_by_visit_;
  std::vector<std::int64_t> uses_;  ///< offsets in parts_ of the parts that add up, in a fixed order
  std::vector<double> right_hand_side_;
  std::vector<ChunkSize> chunk_sizes_;        ///< by chunk
  double signal_share_ = 0.0;                 ///< the largest share of a signal's residual in its terms
  int worst_signal_ = -1, lost_signal_ = -1;  ///< the signal of that, and one whose residual is not finite
  std::vector<char> is_length_;               ///< by unknown: whether it is the multiplier of a constraint of a length
};

}  // namespace bough::step
