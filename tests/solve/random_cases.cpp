#include "random_cases.hpp"

#include <algorithm>
#include <cmath>

namespace bough::test {

namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

bool has_multipliers(const Scene& s, int element) {
  for (auto k = s.graph.element_begin[at(element)]; k < s.graph.element_begin[at(element) + 1]; ++k)
    if (s.graph.block_kind[at(s.graph.element_blocks[at(k)])] == blocks::BlockKind::multiplier) return true;
  return false;
}

/// Every beam between joints of one to six rows, some of them to the ground.
Scene make_joints_everywhere(unsigned seed, int links, double step) {
  SceneMaker m(seed, step);
  constexpr int rows[] = {1, 2, 3, 5, 6};
  std::vector<int> ends{m.add_node()};
  m.add_body(ends[0]);
  for (int l = 0; l < links; ++l) {
    const int from = ends[at(static_cast<int>(m.uniform(0.0, 0.999) * static_cast<double>(ends.size())))];
    const int hinge = m.add_node(), tip = m.add_node();
    m.add_joint({from, hinge}, rows[static_cast<int>(m.uniform(0.0, 4.999))], m.uniform(0.01, 100.0));
    m.add_beam({hinge, tip});
    if (m.uniform(0.0, 1.0) < 0.1) m.add_joint({tip}, rows[static_cast<int>(m.uniform(0.0, 2.999))]);
    ends.push_back(tip);
  }
  return m.finish("joints everywhere");
}

/// Equal arms on a hub: beams, and in the middle a node between two joints (or a pair of nodes with two constraints).
/// One arm is told apart by its numbers alone: no mass on that node, or a second constraint that repeats part of the
/// first.
Case make_equal_arms(unsigned seed, int arms, int length, double step, bool is_massless) {
  SceneMaker m(seed, step);
  Case c;
  const int hub = m.add_node(), odd = static_cast<int>(m.uniform(0.0, 0.999) * arms);
  m.add_body(hub, 10.0);
  int massless = -1;
  const auto add_beams = [&](int& end) {
    for (int b = 0; b < length; ++b) {
      const int next = m.add_node();
      m.add_beam({end, next});
      end = next;
    }
  };
  for (int a = 0; a < arms; ++a) {
    int end = m.add_node();
    m.add_joint({hub, end}, 5);
    add_beams(end);
    const int other = m.add_node();
    if (is_massless) {
      const int between = m.add_node();
      m.add_joint({end, between}, 5);
      m.add_body(between);
      if (a == odd) massless = m.last_element();
      m.add_joint({between, other}, 5);
    } else {
      m.add_joint({end, other}, 3);
      const int joint = m.last_element();
      if (a == odd) {
        m.add_joint_again(joint, 2);
        c.copies.emplace_back(joint, m.last_element());
      } else {
        m.add_joint({end, other}, 2);
      }
    }
    end = other;
    add_beams(end);
  }
  c.scene = m.finish(is_massless ? "equal arms, one with a massless node" : "equal arms, one with dependent rows");
  if (massless >= 0) c.scene.elements[at(massless)].setZero();
  return c;
}

}  // namespace

int Case::deficiency() const {
  int sum = 0;
  for (const auto& copy : copies)
    sum +=
        scene.graph.block_size[at(scene.graph.element_blocks[at(scene.graph.element_begin[at(copy.second) + 1] - 1)])];
  return sum;
}

Eigen::MatrixXd Case::null_vectors() const {
  const auto first = scene.first_unknown();
  const auto multiplier = [&](int element) {
    return scene.graph.element_blocks[at(scene.graph.element_begin[at(element) + 1] - 1)];
  };
  const auto constraint = [&](int element) -> Eigen::MatrixXd {
    const auto& A = scene.elements[at(element)];
    const int rows = scene.graph.block_size[at(multiplier(element))];
    return A.bottomLeftCorner(rows, A.cols() - rows);
  };
  Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(first.back(), deficiency());
  int column = 0;
  for (const auto& [joint, copy] : copies) {  // G_copy = mix G: multipliers (1, -mix^T 1) do nothing
    const Eigen::MatrixXd G = constraint(joint);
    const Eigen::MatrixXd mix = (G * G.transpose()).llt().solve(G * constraint(copy).transpose()).transpose();
    for (Eigen::Index j = 0; j < mix.rows(); ++j, ++column) {
      Z(first[at(multiplier(copy))] + j, column) = 1.0;
      Z.col(column).segment(first[at(multiplier(joint))], mix.cols()) = -mix.row(j).transpose();
    }
  }
  return Z;
}

Case make_case(int number, int unknowns) {
  const auto seed = static_cast<unsigned>(7000 + number);
  std::mt19937 random(seed);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const double step = std::pow(10.0, uniform(-6.0, -2.0));
  const auto share = [&](double per) { return std::max(1, static_cast<int>(unknowns / per)); };
  const int arms = 8 * static_cast<int>(uniform(1.0, 2.999)), side = static_cast<int>(std::sqrt(unknowns / 6.0));
  Case c;
  const int family = number % num_case_families;
  if (unknowns < 7) {
    SceneMaker m(seed, step);
    m.add_body(m.add_node(unknowns));
    c.scene = m.finish("one body");
  } else if (family == 0) {
    c.scene = make_chain(seed, share(35.0), 4, step);
  } else if (family == 1) {
    c.scene = make_tree_of_bodies(seed, share(12.0), step);
  } else if (family == 2) {
    c.scene = make_loop(seed, share(17.0), step);
  } else if (family == 3) {
    c.scene = make_star(seed, 2 + share(40.0) % 11, share(6.0 * (2 + share(40.0) % 11)), step);
  } else if (family == 4) {
    c.scene = make_lattice(seed, std::max(2, side), std::max(2, side), step);
  } else if (family == 5) {
    c.scene = make_parts(seed, std::max(1, static_cast<int>(std::sqrt(unknowns / 1.7))), step);
  } else if (family == 6) {
    c.scene = make_rigid_chain(seed, share(11.0), step);
  } else if (family == 7) {
    c.scene = make_joints_everywhere(seed, share(16.0), step);
  } else {
    c = make_equal_arms(seed, arms, share(12.0 * arms), step, family == 8);
  }
  c.family = family;
  constexpr double decades[] = {0.0, 4.0, 8.0, 12.0};
  const double ratio = decades[number / num_case_families % 4];
  for (int e = 0; e < c.scene.graph.num_elements();
       ++e) {  // beams, with their mass; bodies over a third of the decades
    if (has_multipliers(c.scene, e)) continue;
    const bool is_body = c.scene.graph.element_begin[at(e) + 1] - c.scene.graph.element_begin[at(e)] == 1;
    c.scene.elements[at(e)] *= std::pow(10.0, -(is_body ? ratio / 3.0 : ratio) * uniform(0.0, 1.0));
  }
  constexpr int leaves[] = {0, 1, 2, 3, 5, 8, 17, 1000};
  c.leaf_size = leaves[static_cast<int>(uniform(0.0, 7.999))];
  if (uniform(0.0, 1.0) > 0.4 || family == 9) return c;
  std::vector<int> joints;
  for (int e = 0; e < c.scene.graph.num_elements(); ++e)
    if (has_multipliers(c.scene, e)) joints.push_back(e);
  std::shuffle(joints.begin(), joints.end(), random);
  joints.resize(std::min<std::size_t>(joints.size(), at(1 + number % 4)));
  SceneMaker m(seed + 1, step, std::move(c.scene));
  for (const int joint : joints) {
    m.add_joint_again(joint);
    c.copies.emplace_back(joint, m.last_element());
  }
  c.scene = m.finish("with dependent rows");
  return c;
}

int unknowns_of_case(int number) {
  if (number == 249) return 2500;
  if (number == 499) return 5000;
  std::mt19937 random(static_cast<unsigned>(number));
  return static_cast<int>(std::exp(std::uniform_real_distribution<double>(0.0, std::log(1500.0))(random)));
}

}  // namespace bough::test
