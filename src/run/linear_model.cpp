/// The linearised equations about a state as matrices: E x' = A x + B u, y = C x + D u.
#include "bough/records/linear_model.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "at_state.hpp"
#include "bough/blocks/at.hpp"
#include "linear_ports.hpp"
#include "minimal_form.hpp"
#include "not_judged.hpp"

namespace bough::run {

namespace {

using records::LinearVariable;
using records::SparseEntries;
using step::Linearisation;
using Part = Linearisation::Part;

/// Sums entries of a sparse matrix and lists them row after row.
class EntrySums {
 public:
  EntrySums(int rows, int columns) : columns_(columns), rows_(static_cast<std::size_t>(rows)) {}
  void add(std::size_t row, std::size_t column, double value) {
    if (value != 0.0) rows_[row].emplace_back(static_cast<int>(column), value);
  }
  SparseEntries list() {
    SparseEntries list{static_cast<int>(rows_.size()), columns_, {}, {}, {}};
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      std::stable_sort(rows_[i].begin(), rows_[i].end(), [](auto& a, auto& b) { return a.first < b.first; });
      for (std::size_t k = 0; k < rows_[i].size();) {
        const int column = rows_[i][k].first;
        double sum = 0.0;
        for (; k < rows_[i].size() && rows_[i][k].first == column; ++k) sum += rows_[i][k].second;
        if (sum == 0.0) continue;
        list.row.push_back(static_cast<int>(i));
        list.column.push_back(column);
        list.value.push_back(sum);
      }
    }
    return list;
  }

 private:
  int columns_;
  std::vector<std::vector<std::pair<int, double>>> rows_;
};

/// Name and unit of every unknown, and of the rate of those of nodes.
struct UnknownNames {
  std::vector<LinearVariable> values, rates, accelerations;
};

UnknownNames names_of_unknowns(const step::System& system) {
  static const char* const displacements[] = {"u1", "u2", "u3", "theta1", "theta2", "theta3"};
  static const char* const velocities[] = {"v1", "v2", "v3", "w1", "w2", "w3"};
  static const char* const changes[] = {"a1", "a2", "a3", "b1", "b2", "b3"};
  const plan::Plan& plan = system.plan();
  const step::UnknownPlaces& places = system.places();
  UnknownNames names{std::vector<LinearVariable>(places.size()), std::vector<LinearVariable>(places.size()),
                     std::vector<LinearVariable>(places.size())};
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    const std::int64_t begin = places.node_begin(static_cast<int>(n));
    for (int i = 0; begin >= 0 && i < plan.unknowns.count_of(n); ++i) {
      const auto component = static_cast<std::size_t>(plan.unknowns.component[static_cast<std::size_t>(i)]);
      const bool is_length = component < 3;
      names.values[at(begin + i)] = {plan.nodes[n].name + "." + displacements[component], is_length ? "m" : "rad"};
      names.rates[at(begin + i)] = {plan.nodes[n].name + "." + velocities[component], is_length ? "m/s" : "rad/s"};
      names.accelerations[at(begin + i)] = {plan.nodes[n].name + "." + changes[component],
                                            is_length ? "m/s^2" : "rad/s^2"};
    }
  }
  for (const plan::JointPlan& joint : plan.joints) {
    if (joint.block < 0) continue;
    const std::int64_t begin = places.block_begin(joint.block);
    for (int i = 0; i < places.block_size(joint.block); ++i)
      names.values[at(begin + i)] = {joint.name + ".lambda" + std::to_string(i + 1), "N"};
  }
  for (const step::UnknownPlaces::Multiplier& m : places.multipliers())
    if (!m.is_of_length) names.values[m.unknown].unit = "N m";
  for (std::size_t s = 0; s < places.signals().size(); ++s)
    names.values[places.signals()[s]] = {plan.signals[s].name, plan.signals[s].unit == "-" ? "" : plan.signals[s].unit};
  return names;
}

class LinearModel final : public AtState {
 public:
  explicit LinearModel(const Parts& parts) : AtState(parts) {}
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<LinearModel>(*this); }
  std::string not_judged() const override {
    return one_line({plan_.beams.empty() ? "" : the_mesh, "the model is one of small motions"});
  }

 protected:
  bool look(Linearisation& linear) override {
    inputs_ = inputs_of(scene_, system_);
    outputs_ = outputs_of(scene_, summary().header);
    LinearEquations equations = equations_of(linear);
    auto model = std::make_shared<records::LinearModel>();
    model->about = "Deviations from " + about_.text() + ".";
    for (const LinearPort& port : inputs_) model->inputs.push_back({port.name, port.unit});
    for (const LinearPort& port : outputs_) model->outputs.push_back({port.name, port.unit});
    put_descriptor_form(equations, *model);
    model->why_not_minimal = make_minimal(equations, model->minimal);
    tell(*model);
    summary().linear_model = std::move(model);
    return true;
  }

 private:
  LinearEquations equations_of(const Linearisation& linear);
  void put_output_slopes(LinearEquations& equations);
  void put_descriptor_form(const LinearEquations& equations, records::LinearModel& model) const;
  void tell(const records::LinearModel& model);

  std::vector<LinearPort> inputs_, outputs_;
};

LinearEquations LinearModel::equations_of(const Linearisation& linear) {
  LinearEquations equations;
  const UnknownNames names = names_of_unknowns(system_);
  equations.names = names.values;
  equations.rates = names.rates;
  equations.accelerations = names.accelerations;
  equations.kinds.assign(linear.size(), UnknownKind::motion);
  for (std::size_t i = 0; i < linear.size(); ++i)
    if (linear.is_multiplier(i)) equations.kinds[i] = UnknownKind::multiplier;
  for (std::size_t s = 0; s < system_.places().signals().size(); ++s)
    equations.kinds[system_.places().signals()[s]] =
        plan_.signals[s].is_state() ? UnknownKind::state : UnknownKind::signal;
  equations.weights = linear.weights();
  for (const Part part : {Part::stiffness, Part::damping, Part::mass}) {
    EntrySums sums(static_cast<int>(linear.size()), static_cast<int>(linear.size()));
    for (int e = 0; e < linear.num_elements(); ++e) {
      const std::span<const std::int64_t> unknowns = linear.unknowns_of(e);
      const std::span<const double> entries = linear.matrix_of(part, e);
      for (std::size_t i = 0; i < unknowns.size(); ++i)
        for (std::size_t j = 0; j < unknowns.size(); ++j) {
          const bool is_of_rows = linear.is_multiplier(at(unknowns[i])) || linear.is_multiplier(at(unknowns[j]));
          if (part == Part::stiffness || !is_of_rows)
            sums.add(at(unknowns[i]), at(unknowns[j]), entries[i * unknowns.size() + j]);
        }
    }
    (part == Part::stiffness ? equations.K : part == Part::damping ? equations.C : equations.M) = sums.list();
  }
  for (const LinearPort& input : inputs_) equations.inputs.push_back(input.place);
  put_output_slopes(equations);
  return equations;
}

/// Outputs along every unknown, its rate and its acceleration. A node on which no output depends is left out: nothing
/// changes, to the last bit, where it moves in all of its directions.
void LinearModel::put_output_slopes(LinearEquations& equations) {
  OutputSlopes slopes(system_, state_, about_);
  const std::size_t n = equations.kinds.size();
  std::vector<double> zero(n, 0.0), unit(n, 0.0);
  EntrySums of[] = {{static_cast<int>(outputs_.size()), static_cast<int>(n)},
                    {static_cast<int>(outputs_.size()), static_cast<int>(n)},
                    {static_cast<int>(outputs_.size()), static_cast<int>(n)}};
  const auto add = [&](std::size_t kind, std::size_t unknown) {
    unit[unknown] = 1.0;
    const std::vector<double>& all = kind == 0   ? slopes.eval(unit, zero, zero)
                                     : kind == 1 ? slopes.eval(zero, unit, zero)
                                                 : slopes.eval(zero, zero, unit);
    for (std::size_t k = 0; k < outputs_.size(); ++k) of[kind].add(k, unknown, all[outputs_[k].place]);
    unit[unknown] = 0.0;
  };
  for (std::size_t i = 0; i < n; ++i)
    if (equations.kinds[i] != UnknownKind::motion) add(0, i);
  for (std::size_t node = 0; node < plan_.nodes.size(); ++node) {
    const std::int64_t begin = system_.places().node_begin(static_cast<int>(node));
    const int count = begin < 0 ? 0 : plan_.unknowns.count_of(node);
    if (count == 0 || !slopes.depend_on(node, outputs_)) continue;
    for (int i = 0; i < count; ++i)
      for (const std::size_t kind : {0U, 1U, 2U}) add(kind, at(begin + i));
  }
  equations.of_values = of[0].list();
  equations.of_rates = of[1].list();
  equations.of_accelerations = of[2].list();
}

/// States: all unknowns z, velocities v of motions q among them and, where outputs see them, their accelerations a.
///   q' = v,   M a + C_q v + C_s s' + K z + G^T lambda = b u,   a = v'
void LinearModel::put_descriptor_form(const LinearEquations& equations, records::LinearModel& model) const {
  const std::size_t n = equations.kinds.size();
  std::vector<std::size_t> rate(n), acceleration(n);
  const bool has_accelerations = !equations.of_accelerations.value.empty();
  model.states = equations.names;
  const auto number = [&](std::vector<std::size_t>& places, const std::vector<LinearVariable>& names) {
    for (std::size_t i = 0; i < n; ++i)
      if (equations.kinds[i] == UnknownKind::motion) {
        places[i] = model.states.size();
        model.states.push_back(names[i]);
      }
  };
  number(rate, equations.rates);
  if (has_accelerations) number(acceleration, equations.accelerations);
  const auto size = static_cast<int>(model.states.size()), num_inputs = static_cast<int>(inputs_.size()),
             num_outputs = static_cast<int>(outputs_.size());
  EntrySums E(size, size), A(size, size), B(size, num_inputs), C(num_outputs, size);
  const auto is_motion = [&](int i) { return equations.kinds[at(i)] == UnknownKind::motion; };
  for (std::size_t k = 0; k < equations.K.value.size(); ++k)
    A.add(at(equations.K.row[k]), at(equations.K.column[k]), -equations.K.value[k]);
  for (std::size_t k = 0; k < equations.C.value.size(); ++k) {
    const int i = equations.C.row[k], j = equations.C.column[k];
    if (is_motion(j))
      A.add(at(i), rate[at(j)], -equations.C.value[k]);
    else
      E.add(at(i), at(j), equations.C.value[k]);
  }
  for (std::size_t k = 0; k < equations.M.value.size(); ++k) {
    const int i = equations.M.row[k], j = equations.M.column[k];
    if (!is_motion(j)) continue;
    if (has_accelerations)
      A.add(at(i), acceleration[at(j)], -equations.M.value[k]);
    else
      E.add(at(i), rate[at(j)], equations.M.value[k]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (equations.kinds[i] != UnknownKind::motion) continue;
    // The row of a rate tells q' = v, that of an acceleration v' = a.
    E.add(rate[i], i, 1.0);
    A.add(rate[i], rate[i], 1.0);
    if (!has_accelerations) continue;
    E.add(acceleration[i], rate[i], 1.0);
    A.add(acceleration[i], acceleration[i], 1.0);
  }
  for (std::size_t u = 0; u < inputs_.size(); ++u) B.add(inputs_[u].place, u, 1.0);
  const auto put = [&](const SparseEntries& slopes, auto&& place) {
    for (std::size_t k = 0; k < slopes.value.size(); ++k)
      C.add(at(slopes.row[k]), place(at(slopes.column[k])), slopes.value[k]);
  };
  put(equations.of_values, [](std::size_t i) { return i; });
  put(equations.of_rates, [&](std::size_t i) { return rate[i]; });
  put(equations.of_accelerations, [&](std::size_t i) { return acceleration[i]; });
  model.E = E.list();
  model.A = A.list();
  model.B = B.list();
  model.C = C.list();
  model.D = SparseEntries{num_outputs, num_inputs, {}, {}, {}};
}

void LinearModel::tell(const records::LinearModel& model) {
  records::Table table{
      "linear_model",
      model.about + " E x' = A x + B u, y = C x + D u with " + std::to_string(model.states.size()) + " states x" +
          (model.why_not_minimal.empty()
               ? ", and x' = A x + B u with " + std::to_string(model.minimal.states.size()) + " minimal ones."
               : "; there are no minimal ones: " + model.why_not_minimal + "."),
      {{"what", "", true}, {"number", "", true}, {"name", "", true}, {"unit", "", true}},
      {}};
  const auto list = [&](const char* what, const std::vector<LinearVariable>& variables) {
    for (std::size_t k = 0; k < variables.size(); ++k)
      table.rows.push_back({std::string(what), static_cast<double>(k + 1), variables[k].name, variables[k].unit});
  };
  list("input", model.inputs);
  list("output", model.outputs);
  list("minimal state", model.minimal.states);
  summary().tables.push_back(std::move(table));
}

}  // namespace

std::unique_ptr<Analysis> make_linear_model(const Parts& parts) { return std::make_unique<LinearModel>(parts); }

}  // namespace bough::run
