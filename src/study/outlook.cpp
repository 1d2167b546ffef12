#include "bough/study/outlook.hpp"

#include <algorithm>
#include <memory>

#include "bough/plan/element_cost.hpp"
#include "bough/schedule/serial.hpp"
#include "bough/solve/visits.hpp"
#include "bough/step/state.hpp"
#include "bough/step/system.hpp"

namespace bough::study {

namespace {

constexpr double planar_share = 0.45;  ///< of an element in space
constexpr double per_sum = 55e-9;      ///< gathering, adding and sizing up, an element and evaluation [s]
constexpr double per_node = 110e-9;    ///< moving a node with its velocity and acceleration, an iteration [s]
constexpr double per_front_lanes = 3.5e-6, per_flop_lanes = 3.6e-10;  ///< a visit of eight [s]
constexpr double per_front = 1.5e-6, per_flop = 1.1e-10;
constexpr double per_byte = 6e-11;  ///< of factor and element matrices, a solution and its check [s]

constexpr double usual_iterations = 3.8, usual_evaluations = 4.4, usual_factorizations = 0.4;
constexpr std::int64_t program_bytes = 11'000'000;  ///< resident before a scene is built

std::int64_t bytes_of(const step::System& system) {
  const plan::Plan& plan = system.plan();
  std::int64_t elements = 0, element_unknowns = 0;
  plan::for_each_array(plan.elements, [&](const auto& array) {
    using E = typename std::decay_t<decltype(array)>::value_type;
    elements += static_cast<std::int64_t>(array.size() * sizeof(E));
    element_unknowns += static_cast<std::int64_t>(array.size()) * (6 * E::num_ports);
  });
  const auto nodes = static_cast<std::int64_t>(plan.nodes.size());
  constexpr std::int64_t of_state =
      sizeof(elements::NodeMotion) + sizeof(motion::Quaternion<double>) + 2 * sizeof(motion::Vec6<double>);
  constexpr std::int64_t states = 5, per_node_plan = 2600;  // plan, names, lists, the scene
  return elements * 2 + element_unknowns * 3 * 8 + nodes * (states * of_state + per_node_plan) +
         static_cast<std::int64_t>(system.num_unknowns()) * 6 * 8;
}

struct Built {
  plan::Plan plan;
  step::System system;
  explicit Built(const scene::Scene& scene)
      : plan(plan::make_plan(scene)), system(plan, scene.solver, schedule::make_serial_walker()) {}
};

Effort effort_of(Built& b, const scene::Scene& scene) {
  Effort e;
  const bool reuse = b.plan.took("reuse"), dynamic = b.plan.is_dynamic;
  e.unknowns = b.system.tree().num_unknowns();
  e.iterations = reuse ? usual_iterations : dynamic ? 3.0 : 5.0;
  e.factorizations = reuse ? usual_factorizations : e.iterations;
  const double residuals = reuse ? usual_evaluations : 1.0, tangents = e.factorizations;
  const double share = b.plan.planar ? planar_share : 1.0;
  for (const solve::ElementBatch& batch : b.system.solver().batches()) {
    int present = 0, first = -1;
    for (int id : batch.element) {
      if (id < 0) continue;
      ++present;
      first = first < 0 ? id : first;
    }
    if (first < 0) continue;
    const bool in_lanes = batch.stride == solve::lanes_wide && present >= 3;
    plan::with_element(b.plan.elements, b.plan.directory[static_cast<std::size_t>(first)], [&](const auto& element) {
      const plan::ElementCost& c = plan::cost<std::decay_t<decltype(element)>>;
      const double count = in_lanes ? solve::lanes_wide : present;
      e.evaluate_seconds +=
          share * count *
          (residuals * (in_lanes ? c.lane : c.alone) + tangents * (in_lanes ? c.lane_tangent : c.alone_tangent));
      e.evaluate_seconds += present * per_sum * (residuals + tangents);
    });
  }
  e.other_seconds = static_cast<double>(b.plan.nodes.size()) * per_node * e.iterations;
  if (const solve::Hierarchical* solver = b.system.solver().hierarchical()) {
    const solve::SolveOptions options = step::make_solve_options(b.plan, scene.solver);
    for (const solve::VisitShape& v : solve::make_visit_shapes(b.plan.graph, b.system.tree(), options).visits) {
      const double once = v.in_lanes ? v.num_fronts * per_front_lanes + v.flops * per_flop_lanes
                                     : v.num_fronts * per_front + v.flops * per_flop;
      e.factor_seconds += e.factorizations * once;
      e.solve_seconds += e.iterations * per_byte * static_cast<double>(v.factor_bytes + v.element_bytes);
      e.factor_flops += v.flops * static_cast<double>(v.in_lanes ? v.subdomains.size() : 1);
    }
    e.memory_bytes = solver->counters().memory_bytes;
  } else {
    e.factor_flops = b.system.tree().subdomains.back().subtree_flops;
    e.factor_seconds = e.factorizations * e.factor_flops * 10.0 * per_flop;
    e.memory_bytes = b.system.solver().counters().memory_bytes;
    e.solve_seconds = e.iterations * per_byte * static_cast<double>(e.memory_bytes);
  }
  e.memory_bytes += bytes_of(b.system);
  return e;
}

const char* words(plan::Motions motions) {
  switch (motions) {
    case plan::Motions::planar:
      return "in a plane";
    case plan::Motions::translation:
      return "without rotation";
    case plan::Motions::line:
      return "on a line";
    case plan::Motions::spatial:
      break;
  }
  return "in space";
}

}  // namespace

Outlook look_ahead(const scene::Scene& scene) {
  Outlook out;
  out.scene = scene.name;
  out.title = scene.title;
  Built built(scene);
  const plan::Plan& plan = built.plan;
  out.nodes = plan.nodes.size();
  out.elements = plan.directory.size();
  out.joints = plan.joints.size();
  out.unknowns_in_space = 6 * static_cast<std::int64_t>(out.nodes) + plan.num_multipliers;
  out.motions = words(plan.unknowns.motions);
  const tree::Tree& tree = built.system.tree();
  out.cut = tree.method;
  out.sub_domains = tree.num_subdomains();
  out.fronts = tree.num_fronts();
  for (const tree::Subdomain& s : tree.subdomains) {
    out.leaves += s.is_leaf() ? 1 : 0;
    out.levels = std::max(out.levels, s.level + 1);
  }
  out.effort = effort_of(built, scene);
  out.fronts_in_lanes = static_cast<int>(built.system.solver().counters().fronts_in_lanes);
  out.process_bytes = program_bytes + out.effort.memory_bytes;
  out.notes = plan.notes;
  for (const plan::Decision& d : plan.decisions) {
    OutlookDecision o{d, d.taken && d.can_be_barred, {}};
    if (o.has_saving) {
      scene::Scene other = scene;
      other.without.push_back(d.name);
      Built without(other);
      o.without = effort_of(without, other);
    }
    out.decisions.push_back(o);
  }
  return out;
}

}  // namespace bough::study
