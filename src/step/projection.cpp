#include "projection.hpp"

#include <cmath>

#include "system_parts.hpp"

namespace bough::step {

Projection::Projection(const plan::Plan& plan) {
  const plan::NodeUnknowns& u = plan.unknowns;
  std::vector<const plan::JointPlan*> joint_of(plan.directory.size(), nullptr);
  for (const plan::JointPlan& j : plan.joints) joint_of[static_cast<std::size_t>(j.element)] = &j;
  for (std::size_t id = 0; id < plan.directory.size(); ++id) {
    int whole = 0;
    plan::with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      for (const elements::Port& port : e.ports) {
        if (port.node == elements::ground) continue;
        for (int i = 0; i < u.count; ++i) {
          const int component = u.component[static_cast<std::size_t>(i)], part = component / 3 * 3;
          Unknown unknown;
          if (u.basis.empty()) {
            unknown.place[0] = static_cast<std::int8_t>(whole + component);
            unknown.weight[0] = 1.0;
          } else {
            const motion::Mat3<double>& B = u.basis[static_cast<std::size_t>(port.node)];
            int terms = 0;
            for (int k = 0; k < 3; ++k) {
              if (B(k, component - part) == 0.0) continue;
              unknown.place[static_cast<std::size_t>(terms)] = static_cast<std::int8_t>(whole + part + k);
              unknown.weight[static_cast<std::size_t>(terms++)] = B(k, component - part);
            }
          }
          unknowns_.push_back(unknown);
        }
        whole += 6;
      }
      if (joint_of[id] != nullptr)
        for (int row : joint_of[id]->rows) {
          Unknown unknown;
          unknown.place[0] = static_cast<std::int8_t>(whole + row);
          unknown.weight[0] = 1.0;
          unknowns_.push_back(unknown);
        }
      whole += elements::num_multipliers(e);
    });
    whole_size_.push_back(static_cast<std::int8_t>(whole));
    begin_.push_back(static_cast<std::int64_t>(unknowns_.size()));
  }
}

void Projection::project_vector(std::size_t element, const double* from, double* to) const {
  for (std::int64_t k = begin_[element]; k < begin_[element + 1]; ++k) {
    const Unknown& u = unknowns_[static_cast<std::size_t>(k)];
    double sum = 0.0;
    for (std::size_t i = 0; i < 3 && u.place[i] >= 0; ++i) sum += u.weight[i] * from[u.place[i]];
    *to++ = sum;
  }
}

void Projection::project_sizes(std::size_t element, const double* from, double* to) const {
  for (std::int64_t k = begin_[element]; k < begin_[element + 1]; ++k) {
    const Unknown& u = unknowns_[static_cast<std::size_t>(k)];
    double sum = 0.0;
    for (std::size_t i = 0; i < 3 && u.place[i] >= 0; ++i) sum += std::abs(u.weight[i]) * from[u.place[i]];
    *to++ = sum;
  }
}

int Projection::project_matrix(std::size_t element, const double* from, double* to) const {
  const Unknown* const unknowns = unknowns_.data() + begin_[element];
  const int n = static_cast<int>(begin_[element + 1] - begin_[element]), whole = whole_size_[element];
  std::array<double, most_unknowns> row;
  for (int i = 0; i < n; ++i) {
    const Unknown& u = unknowns[i];
    row.fill(0.0);
    for (std::size_t k = 0; k < 3 && u.place[k] >= 0; ++k)
      for (int j = 0; j < whole; ++j) row[static_cast<std::size_t>(j)] += u.weight[k] * from[u.place[k] * whole + j];
    for (int j = 0; j < n; ++j) {
      const Unknown& v = unknowns[j];
      double sum = 0.0;
      for (std::size_t k = 0; k < 3 && v.place[k] >= 0; ++k)
        sum += v.weight[k] * row[static_cast<std::size_t>(v.place[k])];
      to[i * n + j] = sum;
    }
  }
  return n;
}

}  // namespace bough::step
