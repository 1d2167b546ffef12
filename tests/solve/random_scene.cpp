#include "random_scene.hpp"

namespace bough::test {

using Eigen::MatrixXd;

int Scene::num_unknowns() const { return first_unknown().back(); }

std::vector<int> Scene::first_unknown() const {
  std::vector<int> first{0};
  for (int n : graph.block_size) first.push_back(first.back() + n);
  return first;
}

MatrixXd Scene::dense() const {
  const auto first = first_unknown();
  MatrixXd A = MatrixXd::Zero(first.back(), first.back());
  for (int e = 0; e < graph.num_elements(); ++e) {
    std::vector<int> index;
    for (auto k = graph.element_begin[static_cast<std::size_t>(e)];
         k < graph.element_begin[static_cast<std::size_t>(e) + 1]; ++k) {
      const auto b = static_cast<std::size_t>(graph.element_blocks[static_cast<std::size_t>(k)]);
      for (int i = 0; i < graph.block_size[b]; ++i) index.push_back(first[b] + i);
    }
    for (std::size_t i = 0; i < index.size(); ++i)
      for (std::size_t j = 0; j < index.size(); ++j)
        A(index[i], index[j]) += elements[static_cast<std::size_t>(e)](static_cast<int>(i), static_cast<int>(j));
  }
  return A;
}

MatrixXd SceneMaker::uniform_matrix(int rows, int columns) {
  MatrixXd m(rows, columns);
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < rows; ++i) m(i, j) = uniform(-1.0, 1.0);
  return m;
}

MatrixXd SceneMaker::transport(int size) {
  MatrixXd R = Eigen::HouseholderQR<MatrixXd>(uniform_matrix(size / 2, size / 2)).householderQ();
  if (size % 2 != 0 || size < 6) return MatrixXd::Identity(size, size);
  MatrixXd Ad = MatrixXd::Zero(6, 6);
  const double x = uniform(-0.5, 0.5), y = uniform(-0.5, 0.5), z = uniform(-0.5, 0.5);
  MatrixXd cross(3, 3);
  cross << 0, -z, y, z, 0, -x, -y, x, 0;
  Ad << R, cross * R, MatrixXd::Zero(3, 3), R;
  return Ad;
}

int SceneMaker::add_element(const std::vector<int>& blocks, const MatrixXd& matrix) {
  auto& g = scene_.graph;
  g.element_blocks.insert(g.element_blocks.end(), blocks.begin(), blocks.end());
  g.element_begin.push_back(static_cast<std::int64_t>(g.element_blocks.size()));
  scene_.elements.push_back(matrix);
  return g.num_elements() - 1;
}

int SceneMaker::add_node(int size) {
  scene_.graph.block_size.push_back(size);
  scene_.graph.block_kind.push_back(blocks::BlockKind::motion);
  return scene_.graph.num_blocks() - 1;
}

void SceneMaker::add_beam(const std::vector<int>& nodes, double unsymmetry) {
  const int size = scene_.graph.block_size[static_cast<std::size_t>(nodes[0])];
  const int n = size * static_cast<int>(nodes.size());
  MatrixXd A = MatrixXd::Zero(n, n);
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {  // one relative motion for each neighbouring pair
    MatrixXd B = MatrixXd::Zero(size, n);
    B.middleCols(static_cast<int>(k) * size, size) = -transport(size);
    B.middleCols(static_cast<int>(k + 1) * size, size) = MatrixXd::Identity(size, size);
    Eigen::VectorXd C(size);
    for (int i = 0; i < size; ++i) C(i) = (i < size / 2 ? 1e8 : 1e4) * uniform(0.5, 2.0);
    A += B.transpose() * C.asDiagonal() * B;
  }
  if (step_ > 0.0) {
    const MatrixXd X = uniform_matrix(n, n);
    Eigen::VectorXd d(n);
    for (int i = 0; i < n; ++i) d(i) = i % size < size / 2 ? 1.0 : 0.1;
    A += (0.2 / (step_ * step_)) *
         (d.asDiagonal() * (MatrixXd::Identity(n, n) + 0.05 * X * X.transpose()) * d.asDiagonal());
  }
  const Eigen::VectorXd scale = A.diagonal().cwiseSqrt();
  const MatrixXd X = uniform_matrix(n, n);
  A += unsymmetry * 0.1 * (scale.asDiagonal() * (X - X.transpose()) * scale.asDiagonal());
  add_element(nodes, A);
}

void SceneMaker::add_body(int node, double factor) {
  const int n = scene_.graph.block_size[static_cast<std::size_t>(node)];
  const MatrixXd X = uniform_matrix(n, n);
  add_element({node},
              (factor / (step_ > 0.0 ? step_ * step_ : 1.0)) * (MatrixXd::Identity(n, n) + 0.1 * X * X.transpose()));
}

int SceneMaker::add_joint(const std::vector<int>& nodes, int rows, double row_scale) {
  const int size = scene_.graph.block_size[static_cast<std::size_t>(nodes[0])];
  scene_.graph.block_size.push_back(rows);
  scene_.graph.block_kind.push_back(blocks::BlockKind::multiplier);
  const int multiplier = scene_.graph.num_blocks() - 1;
  const MatrixXd W =
      row_scale *
      MatrixXd(MatrixXd(Eigen::HouseholderQR<MatrixXd>(uniform_matrix(size, size)).householderQ()).topRows(rows));
  MatrixXd G(rows, size * static_cast<int>(nodes.size()));
  if (nodes.size() == 2) {
    G << -W * transport(size), W;
  } else {
    G << W;
  }
  const int n = static_cast<int>(G.cols());
  MatrixXd A = MatrixXd::Zero(n + rows, n + rows);
  A.topRightCorner(n, rows) = G.transpose();
  A.bottomLeftCorner(rows, n) = G;
  std::vector<int> blocks = nodes;
  blocks.push_back(multiplier);
  add_element(blocks, A);
  return multiplier;
}

int SceneMaker::add_joint_again(int element, int copied) {
  const auto e = static_cast<std::size_t>(element);
  auto& g = scene_.graph;
  std::vector<int> blocks(g.element_blocks.begin() + g.element_begin[e],
                          g.element_blocks.begin() + g.element_begin[e + 1]);
  const int rows = g.block_size[static_cast<std::size_t>(blocks.back())];
  if (copied == 0) copied = rows;
  g.block_size.push_back(copied);
  g.block_kind.push_back(blocks::BlockKind::multiplier);
  blocks.back() = g.num_blocks() - 1;
  const int n = static_cast<int>(scene_.elements[e].rows()) - rows;
  const MatrixXd mix = uniform_matrix(copied, rows) + 2.0 * MatrixXd::Identity(copied, rows);
  MatrixXd A = MatrixXd::Zero(n + copied, n + copied);
  A.bottomLeftCorner(copied, n) = mix * scene_.elements[e].bottomLeftCorner(rows, n);
  A.topRightCorner(n, copied) = A.bottomLeftCorner(copied, n).transpose();
  add_element(blocks, A);
  return blocks.back();
}

Scene SceneMaker::finish(std::string name) {
  scene_.name = std::move(name);
  return scene_;
}

Scene make_symmetric(Scene scene) {
  for (Eigen::MatrixXd& a : scene.elements) a = Eigen::MatrixXd(0.5 * (a + a.transpose()));
  return scene;
}

Scene make_definite(Scene scene) {
  for (blocks::BlockKind& kind : scene.graph.block_kind) kind = blocks::BlockKind::motion;
  for (MatrixXd& a : scene.elements) {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(MatrixXd(0.5 * (a + a.transpose())));
    const MatrixXd b =
        modes.eigenvectors() * modes.eigenvalues().cwiseAbs().asDiagonal() * modes.eigenvectors().transpose();
    a = 0.5 * (b + b.transpose());
  }
  return scene;
}

Scene make_hinged_beams(unsigned seed, int beams, int again) {
  SceneMaker m(seed);
  int end = m.add_node();
  m.add_joint({end}, 6);
  for (int l = 0; l < beams; ++l) {
    const int next = m.add_node();
    m.add_beam({end, next});
    end = m.add_node();
    m.add_joint({next, end}, 5);
    if (again > 0 && l % again == 1) m.add_joint_again(m.last_element());
    m.add_body(end, 0.1);
  }
  return m.finish(again > 0 ? "hinged beams, dependent rows" : "hinged beams");
}

Scene make_chain(unsigned seed, int links, int beams_per_link, double step) {
  SceneMaker m(seed, step);
  int end = m.add_node();
  m.add_joint({end}, 6);
  for (int l = 0; l < links; ++l) {
    if (l > 0) {
      const int next = m.add_node();
      m.add_joint({end, next}, 5, m.uniform(0.1, 10.0));
      end = next;
    }
    for (int b = 0; b < beams_per_link; ++b) {
      const int next = m.add_node();
      m.add_beam({end, next});
      end = next;
    }
  }
  return m.finish("chain");
}

Scene make_tree_of_bodies(unsigned seed, int bodies, double step) {
  SceneMaker m(seed, step);
  std::vector<int> nodes{m.add_node()};
  m.add_joint({nodes[0]}, 5);
  for (int i = 0; i < bodies; ++i) {
    int from = nodes[static_cast<std::size_t>(m.uniform(0.0, 1.0) * static_cast<double>(nodes.size()) * 0.999)];
    if (m.uniform(0.0, 1.0) < 0.5) {
      const int hinge = m.add_node();
      m.add_joint({from, hinge}, m.uniform(0.0, 1.0) < 0.5 ? 5 : 3);
      from = hinge;
    }
    const int middle = m.add_node();
    if (m.uniform(0.0, 1.0) < 0.3) {
      const int tip = m.add_node();
      m.add_beam({from, middle, tip});
      nodes.push_back(tip);
    } else {
      m.add_beam({from, middle});
    }
    if (m.uniform(0.0, 1.0) < 0.2) m.add_body(middle);
    nodes.push_back(middle);
  }
  return m.finish("tree");
}

Scene make_loop(unsigned seed, int links, double step) {
  SceneMaker m(seed, step);
  const int first = m.add_node();
  int end = first;
  for (int l = 0; l < links; ++l) {
    const int tip = m.add_node();
    m.add_beam({end, tip});
    end = m.add_node();
    m.add_joint({tip, end}, 5);
    m.add_body(end, 0.1);
  }
  m.add_beam({end, first});
  m.add_joint({first}, 3);
  m.add_body(first);
  return m.finish("loop");
}

Scene make_star(unsigned seed, int arms, int length, double step) {
  SceneMaker m(seed, step);
  const int hub = m.add_node();
  m.add_body(hub, 10.0);
  for (int a = 0; a < arms; ++a) {
    int end = m.add_node();
    m.add_joint({hub, end}, a % 2 == 0 ? 5 : 6);
    for (int b = 0; b < length; ++b) {
      const int next = m.add_node();
      m.add_beam({end, next});
      end = next;
    }
  }
  return m.finish("star");
}

Scene make_lattice(unsigned seed, int nx, int ny, double step) {
  SceneMaker m(seed, step);
  std::vector<int> nodes;
  for (int i = 0; i < nx * ny; ++i) nodes.push_back(m.add_node());
  const auto at = [&](int i, int j) { return nodes[static_cast<std::size_t>(i + nx * j)]; };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      for (const auto& [di, dj] : {std::pair{1, 0}, std::pair{0, 1}}) {
        if (i + di >= nx || j + dj >= ny) continue;
        if (m.uniform(0.0, 1.0) < 0.15) {
          const int hinge = m.add_node();
          m.add_joint({at(i, j), hinge}, 5);
          m.add_beam({hinge, at(i + di, j + dj)});
        } else {
          m.add_beam({at(i, j), at(i + di, j + dj)});
        }
      }
    }
  for (int j = 0; j < ny; ++j) m.add_joint({at(0, j)}, 6);
  return m.finish("lattice");
}

Scene make_parts(unsigned seed, int parts, double step) {
  SceneMaker m(seed, step);
  for (int p = 0; p < parts; ++p) {  // floating chains of a few sizes of nodes; dynamics holds them
    const int size = p % 3 == 0 ? 6 : p % 3 == 1 ? 3 : 1;
    int end = m.add_node(size);
    m.add_body(end);
    for (int b = 0; b < 1 + p; ++b) {
      const int next = m.add_node(size);
      m.add_beam({end, next});
      if (size == 3 && b == 0) m.add_joint({end, next}, 1);
      end = next;
    }
  }
  return m.finish("parts");
}

Scene make_rigid_chain(unsigned seed, int links, double step) {
  SceneMaker m(seed, step);
  int last = -1;
  for (int l = 0; l < links; ++l) {
    const int body = m.add_node();
    if (last < 0) {
      m.add_joint({body}, 5);
    } else {
      m.add_joint({last, body}, 5);
    }
    m.add_body(body);
    last = body;
  }
  return m.finish("rigid chain");
}

std::vector<Scene> make_all_families(unsigned seed, double step) {
  return {make_chain(seed, 5, 4, step),        make_tree_of_bodies(seed + 1, 14, step), make_loop(seed + 2, 6, step),
          make_star(seed + 3, 5, 3, step),     make_lattice(seed + 4, 4, 4, step),      make_parts(seed + 5, 6, step),
          make_rigid_chain(seed + 6, 12, step)};
}

}  // namespace bough::test
