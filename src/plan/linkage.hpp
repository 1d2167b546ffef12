#pragma once
/// Rigid parts that joints connect, and the motions that these leave them at the start: internal to plan.
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "bough/motion/se3.hpp"

namespace bough::plan {

using Vec3d = motion::Vec3<double>;
/// Velocity of a rigid part in the ground's axes: (v, w), v that of the point at the linkage's center, in lengths of
/// its size a second.
using Twist = Eigen::Matrix<double, 6, 1>;

/// What holds the second part to the first: rows . (twist of the second - twist of the first) = 0.
struct LinkEdge {
  int first = 0, second = 0;
  std::string name;
  std::vector<Twist> rows;
  Vec3d axis = Vec3d::zero();  ///< of a joint, in the ground; zero: none
  bool is_joint = true;        ///< of the scene; else something that holds like one
  bool is_beam = false;        ///< taken as rigid
};

/// Parts that edges connect, the ground not counted as one.
struct LinkComponent {
  std::vector<int> parts;  ///< parents before their children
  std::vector<int> edges;  ///< all at these parts
  int freedoms = 0;        ///< left by the edges of a spanning tree, 6 more where nothing ties the parts to the ground
  int closing_rows = 0;    ///< of the edges that close loops
  int rank = 0;            ///< of these
  bool is_rank_known = true;  ///< false: too large to find it; it is then taken to be full
  bool reaches_ground = false;
  int mobility() const { return freedoms - rank; }
  /// Twists of all parts for each independent motion that is left, [6 * parts.size() x mobility]. Empty where the
  /// component is too large.
  Eigen::MatrixXd motions;
  std::map<int, int> place;  ///< of a part in `parts`
  Twist twist_of(int part, Eigen::Index motion) const;
};

class Linkage {
 public:
  static constexpr int ground = 0;

  Linkage(Vec3d center, double size) : center_(center), size_(size) {}
  int add_part() { return num_parts_++; }
  void add(LinkEdge edge) { edges_.push_back(std::move(edge)); }

  /// Rows of the velocity, along a direction, of the point x of a part, and of its rotation about a direction.
  Twist along(const Vec3d& direction, const Vec3d& x) const;
  static Twist about(const Vec3d& direction);

  const std::vector<LinkEdge>& edges() const { return edges_; }
  /// Motions of every component; `relaxed`: an edge that lets its two sides turn against each other, -1: none.
  std::vector<LinkComponent> solve(int relaxed = -1) const;

  const Vec3d& center() const { return center_; }
  double size() const { return size_; }

 private:
  std::vector<Twist> rows_of(int edge, int relaxed) const;

  Vec3d center_;
  double size_;
  int num_parts_ = 1;
  std::vector<LinkEdge> edges_;
};

}  // namespace bough::plan
