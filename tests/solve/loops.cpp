#include "loops.hpp"

#include <cmath>

namespace bough::test {

namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

struct Body {
  int node;
  Vector3d centre;
  Matrix3d axes;  ///< its own, of its rotations; the second along the bar
};

Matrix3d cross(const Vector3d& a) {
  Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// Rows of a pin at p: the point's three displacements, and the rotations about two axes normal to its own.
MatrixXd pin_rows(const Vector3d& p, const Body& body, double misaligned) {
  MatrixXd g = MatrixXd::Zero(5, 6);
  g.topLeftCorner(3, 3).setIdentity();
  g.topRightCorner(3, 3) = -cross(p - body.centre) * body.axes;
  g.block(3, 3, 1, 3) = body.axes.row(0);
  g.block(4, 3, 1, 3) = std::cos(misaligned) * body.axes.row(1) + std::sin(misaligned) * body.axes.row(2);
  return g;
}

}  // namespace

Scene make_loops(const LoopOptions& o) {
  SceneMaker m(1, o.step);
  std::vector<std::pair<int, MatrixXd>> elements;
  const auto add_bar = [&](const Vector3d& from, const Vector3d& to) {
    const int node = m.add_node();
    m.add_body(node);
    const double length = (to - from).norm();
    const Vector3d axis = (to - from) / length, normal = Vector3d::UnitZ();
    Matrix3d axes;
    axes << axis.cross(normal), axis, normal;
    MatrixXd mass = MatrixXd::Identity(6, 6);
    mass.bottomRightCorner(3, 3).diagonal() << length * length / 12.0, o.own_inertia, length * length / 12.0;
    elements.emplace_back(m.last_element(), mass / (o.step * o.step));
    return Body{node, 0.5 * (from + to), axes};
  };
  const auto add_pin = [&](const Vector3d& p, const std::vector<Body>& bodies, double misaligned = 0.0) {
    std::vector<int> nodes;
    for (const Body& b : bodies) nodes.push_back(b.node);
    m.add_joint(nodes, 5);
    const auto columns = static_cast<Eigen::Index>(6 * bodies.size());
    MatrixXd a = MatrixXd::Zero(columns + 5, columns + 5);
    for (std::size_t k = 0; k < bodies.size(); ++k)
      a.block(columns, static_cast<Eigen::Index>(6 * k), 5, 6) =
          (k == 0 ? 1.0 : -1.0) * pin_rows(p, bodies[k], misaligned);
    a.topRightCorner(columns, 5) = a.bottomLeftCorner(5, columns).transpose();
    elements.emplace_back(m.last_element(), a);
  };
  const auto pin = [&](int i, int floor) {
    return Vector3d{i - floor * std::sin(o.tilt), floor * std::cos(o.tilt), 0.0};
  };
  std::vector<Body> below;
  for (int f = 0; f < o.floors; ++f) {
    std::vector<Body> upright;
    for (int i = 0; i <= o.columns; ++i) {
      upright.push_back(add_bar(pin(i, f), pin(i, f + 1)));
      if (f == 0)
        add_pin(pin(i, f), {upright.back()});
      else
        add_pin(pin(i, f), {below[static_cast<std::size_t>(i)], upright.back()});
      if (i == 0) continue;
      const Body coupler = add_bar(pin(i - 1, f + 1), pin(i, f + 1));
      add_pin(pin(i - 1, f + 1), {upright[static_cast<std::size_t>(i - 1)], coupler});
      add_pin(pin(i, f + 1), {upright.back(), coupler}, f == 0 && i == 1 ? o.misaligned : 0.0);
    }
    below = upright;
  }
  if (o.long_bar) {
    const Body bar = add_bar(pin(0, o.floors), pin(o.columns, o.floors));
    add_pin(pin(0, o.floors), {below.front(), bar});
    add_pin(pin(o.columns, o.floors), {below.back(), bar});
  }
  Scene scene = m.finish("loops");
  for (const auto& [element, matrix] : elements) scene.elements[static_cast<std::size_t>(element)] = matrix;
  return scene;
}

}  // namespace bough::test
