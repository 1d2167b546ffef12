#pragma once
/// Random matrices shaped like those of flexible multibody scenes: beams, rigid bodies and joints on SE(3)-like
/// nodes. Test data only.
#include <Eigen/Dense>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "bough/blocks/block_graph.hpp"

namespace bough::test {

struct Scene {
  std::string name;
  blocks::BlockGraph graph;
  std::vector<Eigen::MatrixXd> elements;

  int num_unknowns() const;
  Eigen::MatrixXd dense() const;
  std::vector<int> first_unknown() const;  ///< of each block
};

/// Builds scenes from nodes, beams and joints. Everything comes from one local seed.
class SceneMaker {
 public:
  explicit SceneMaker(unsigned seed, double step = 1e-3) : random_(seed), step_(step) {}
  /// Goes on with a scene.
  SceneMaker(unsigned seed, double step, Scene scene) : random_(seed), step_(step), scene_(std::move(scene)) {}

  int add_node(int size = 6);
  /// K + M / h^2 of a beam between nodes: K = B^T C B with B = [-Ad, I] (rigid motions are its null space), M
  /// positive definite; unsymmetric: a few per cent of a skew part, structure symmetric. step <= 0: no mass
  /// (statics).
  void add_beam(const std::vector<int>& nodes, double unsymmetry = 0.05);
  /// Inertia of a rigid body or a point load's tangent: one block.
  void add_body(int node, double size = 1.0);
  /// rows multipliers between one or two nodes: [0 G^T; G 0] with G = W [-Ad, I] (or W on one node), W of full row
  /// rank. Returns the multiplier block.
  int add_joint(const std::vector<int>& nodes, int rows, double row_scale = 1.0);
  /// The same constraint once more (rows of W combined anew), consistent with the first: dependent rows; as many as
  /// it has, or `rows`.
  int add_joint_again(int joint_element, int rows = 0);

  Scene finish(std::string name);
  std::mt19937& random() { return random_; }
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  Eigen::MatrixXd uniform_matrix(int rows, int columns);
  int last_element() const { return scene_.graph.num_elements() - 1; }

 private:
  Eigen::MatrixXd transport(int size);
  int add_element(const std::vector<int>& blocks, const Eigen::MatrixXd& matrix);
  std::mt19937 random_;
  double step_;
  Scene scene_;
};

/// The same graph with every element matrix Q |L| Q^T instead of its symmetric part Q L Q^T: positive definite.
/// Multipliers become motion.
Scene make_definite(Scene scene);
/// Element matrices become their symmetric parts.
Scene make_symmetric(Scene scene);

/// Scenes of the families: chain, tree, loop, star, lattice, parts (several unconnected), rigid chain, with joints
/// sprinkled in.
Scene make_chain(unsigned seed, int links, int beams_per_link, double step = 1e-3);
/// Beams with light bodies at their ends, on hinges; every `again`-th hinge is said twice, so that rows depend (0:
/// none).
Scene make_hinged_beams(unsigned seed, int beams, int again);
Scene make_tree_of_bodies(unsigned seed, int bodies, double step = 1e-3);
Scene make_loop(unsigned seed, int links, double step = 1e-3);
Scene make_star(unsigned seed, int arms, int length, double step = 1e-3);
Scene make_lattice(unsigned seed, int nx, int ny, double step = 1e-3);
Scene make_parts(unsigned seed, int parts, double step = 1e-3);
Scene make_rigid_chain(unsigned seed, int links, double step = 1e-3);
std::vector<Scene> make_all_families(unsigned seed, double step = 1e-3);

}  // namespace bough::test
