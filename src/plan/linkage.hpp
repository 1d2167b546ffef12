#pragma once
/// Rigid parts connected by joints, and the motions that the joints allow at the start. Internal to plan.
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "bough/motion/se3.hpp"

namespace bough::plan {

using Vec3d = motion::Vec3<double>;
/// Velocity of a rigid part in the ground's axes: (v, w), where v is the velocity of the point at the linkage's center,
/// in units of the linkage's size per second.
using Twist = Eigen::Matrix<double, 6, 1>;

/// A connection of two parts: rows . (twist of the second - twist of the first) = 0.
struct LinkEdge {
  int first = 0, second = 0;
  std::string name;
  std::vector<Twist> rows;
  Vec3d axis = Vec3d::zero();  ///< axis of a joint, in the ground; zero: none
  bool is_joint = true;        ///< a joint of the scene; false: another part that constrains like a joint
  bool is_beam = false;        ///< a beam taken to be rigid
  bool is_rod = false;         ///< a joint that joins points, whose line turns where its sides move across it
};

/// A set of connected parts, where the ground does not count as a connection.
struct LinkComponent {
  std::vector<int> parts;  ///< parents before their children
  std::vector<int> edges;  ///< all edges between these parts
  int freedoms = 0;      ///< left by the edges of a spanning tree, 6 more if the parts are not connected to the ground
  int closing_rows = 0;  ///< rows of the edges that close loops
  int rank = 0;          ///< rank of the closing rows
  bool is_rank_known = true;  ///< false: the component is too large to compute the rank, which is taken to be full
  bool reaches_ground = false;
  int mobility() const { return freedoms - rank; }
  /// Twists of all parts for each independent motion that remains, [6 * parts.size() x mobility]. Empty if the
  /// component is too large, or its motions were not asked for.
  Eigen::MatrixXd motions;
  std::map<int, int> place;  ///< index of a part in `parts`
  Twist twist_of(int part, Eigen::Index motion) const;
};

/// Components whose motions Linkage::solve computes. `none`: freedoms and ranks alone; `loops`: of components without
/// loops not even ranks.
enum class MotionsOf { none, loops, all };

class Linkage {
 public:
  static constexpr int ground = 0;

  /// Rows have lengths of about 1, and depend on each other where pivots are below `least_pivot`.
  Linkage(Vec3d center, double size, double least_pivot) : center_(center), size_(size), least_pivot_(least_pivot) {}
  int add_part() { return num_parts_++; }
  void add(LinkEdge edge) { edges_.push_back(std::move(edge)); }
  void reserve(std::size_t num_edges) { edges_.reserve(num_edges); }

  /// Rows for the velocity of the point x of a part along a direction, and for the rotation of the part about a
  /// direction.
  Twist along(const Vec3d& direction, const Vec3d& x) const;
  static Twist about(const Vec3d& direction);

  const std::vector<LinkEdge>& edges() const { return edges_; }
  /// All components. `relaxed`: an edge that is modified to let its sides rotate relative to each other; -1: none.
  std::vector<LinkComponent> solve(MotionsOf wanted, int relaxed = -1) const;

  const Vec3d& center() const { return center_; }
  double size() const { return size_; }

 private:
  std::vector<Twist> rows_of(int edge, int relaxed) const;
  int num_rows(int edge, int relaxed) const;

  Vec3d center_;
  double size_;
  double least_pivot_;
  int num_parts_ = 1;
  std::vector<LinkEdge> edges_;
};

}  // namespace bough::plan
