/// Elements in lanes against the same elements alone.
#include <gtest/gtest.h>

#include "bough/elements/energies.hpp"
#include "elements/check_element.hpp"

namespace bough::elements::check {
namespace {

void vary(double& x, Numbers& numbers) { x *= 1.0 + numbers.next(0.2); }
void vary(Mat6<double>& m, Numbers& numbers) {
  const double factor = 1.0 + numbers.next(0.2);
  for (double& x : m.m) x *= factor;
}
void vary(Vec6<double>& v, Numbers& numbers) { v += numbers.vec6(0.1); }
template <int N>
void vary_element(Beam<N>& e, Numbers& numbers) {
  vary(e.length, numbers);
  vary(e.stiffness, numbers);
  vary(e.damping, numbers);
  vary(e.mass, numbers);
  for (auto& strain : e.reference_strain) vary(strain, numbers);
}
template <int N>
void vary_element(LineLoad<N>& e, Numbers& numbers) {
  vary(e.length, numbers);
  vary(e.wrench, numbers);
}
void vary_element(RigidBody& e, Numbers& numbers) { vary(e.mass, numbers); }
void vary_element(PointLoad& e, Numbers& numbers) { vary(e.wrench, numbers); }
void vary_element(Spring& e, Numbers& numbers) {
  vary(e.stiffness, numbers);
  vary(e.rest_length, numbers);
  vary(e.damping, numbers);
}
void vary_element(Bushing& e, Numbers& numbers) {
  vary(e.stiffness, numbers);
  vary(e.damping, numbers);
  vary(e.rest, numbers);
}
template <IsCatalogued E>
void vary_element(E& e, Numbers& numbers) {
  const auto change = [&](double, double& x) { x *= 1.0 + numbers.next(0.1); };
  const NumbersOf visit(change);
  E::visit_data(e, e, visit);
}
void vary_element(Joint& e, Numbers& numbers) {
  for (int k = 0; k < e.num_rows; ++k) vary(e.rows[k].constant, numbers);
  for (int k = 0; k < e.num_efforts; ++k) {
    vary(e.efforts[k].stiffness, numbers);
    vary(e.efforts[k].rest, numbers);
    vary(e.efforts[k].damping, numbers);
  }
}
Frame<double> moved(const Frame<double>& H, Numbers& numbers, double by) {
  return motion::compose(H, motion::exp_se3(numbers.vec6(by)));
}

/// Sample number `seed` of a kind; seed 0 turns no frame against another (all relative rotations are exactly zero).
template <class E>
Sample<E> varied(Sample<E> s, unsigned seed) {
  Numbers numbers(1000 + seed);
  vary_element(s.element, numbers);
  for (auto& port : s.element.ports)
    if (port.has_offset || port.node == ground) port.offset = moved(port.offset, numbers, 0.2);
  for (NodeMotion& n : s.nodes) {
    const Frame<double> H = moved({n.R, n.x.hi}, numbers, seed % 3 == 1 ? 1e-7 : 0.4);
    n = {seed == 0 ? Mat3<double>::identity() : H.R, {H.x, numbers.vec3(1e-17)},   numbers.vec6(), numbers.vec6(),
         numbers.vec6(seed == 0 ? 0.0 : 0.4),        0.3 * lanes::linear_part(n.a)};
  }
  for (double& x : s.multipliers) x = numbers.next();
  for (double& x : s.laws) x = numbers.next();
  s.turns = 6.1 + numbers.next(0.1);
  return s;
}

/// To round-off of their own size.
void expect_same_energies(const std::vector<double>& got, const std::vector<double>& alone) {
  ASSERT_EQ(got.size(), alone.size());
  double most = 0.0;
  for (double e : alone) most = std::max(most, std::abs(e));
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], alone[i], 16.0 * 0x1p-53 * most) << i;
}

struct LaneResult {
  std::vector<double> residual, magnitude, tangent, energies;  ///< entry-major, num_lanes to an entry
};

/// Loads store nothing.
template <class E>
constexpr bool has_energies = !requires(const E& e) {
  e.wrench;
};

template <class S>
std::vector<S> list_of(const EnergiesOf<S>& e) {
  std::vector<S> list = {e.kinetic, e.strain, e.mass};
  for (int i = 0; i < 6; ++i) list.push_back(e.momentum[i]);
  for (int i = 0; i < 3; ++i) list.push_back(e.mass_moment[i]);
  return list;
}

template <class E>
std::vector<double> energies_alone(const Sample<E>& s, const Field& field) {
  if constexpr (has_energies<E>) return list_of(eval_energies(s.element, field, s.turns));
  return {};
}

template <class E>
LaneResult lane_results(const std::vector<Sample<E>>& samples, bool has_inertia, const Slopes& slopes,
                        const CarrierMotion* frame = nullptr) {
  const int count = static_cast<int>(samples.size());
  std::vector<const E*> elements;
  for (const Sample<E>& s : samples) elements.push_back(&s.element);
  int nodes[E::num_ports], laws[max_laws];
  for (int k = 0; k < E::num_ports; ++k) nodes[k] = k;
  const LaneElement<E> e = make_lane_element(elements.data(), count, nodes, 1);
  std::vector<NodeLanes> motions(E::num_ports);
  std::vector<LanePack> law_values(max_laws + 1, LanePack(0.0)), multipliers(max_rows, LanePack(0.0));
  LanePack turns(0.0);
  const double* from[E::num_ports][num_lanes] = {};
  for (int lane = 0; lane < num_lanes; ++lane) {
    const Sample<E>& s = samples[static_cast<std::size_t>(std::min(lane, count - 1))];
    for (int k = 0; k < E::num_ports; ++k)
      if (s.element.ports[k].node != ground)
        from[k][lane] = reinterpret_cast<const double*>(s.nodes.data() + s.element.ports[k].node);
    const int n = list_laws(s.element, laws);
    for (int k = 0; k < n; ++k)
      law_values[static_cast<std::size_t>(k + 1)].set(lane, s.laws[static_cast<std::size_t>(laws[k])]);
    for (std::size_t k = 0; k < s.multipliers.size(); ++k) multipliers[k].set(lane, s.multipliers[k]);
    turns.set(lane, s.turns);
  }
  for (int k = 0; k < E::num_ports; ++k)
    if (from[k][0] != nullptr)
      lanes::gather_lanes(from[k], numbers_of_node<motion::Se3>, reinterpret_cast<LanePack*>(motions.data() + k));
  CarrierLanes frame_lanes;
  if (frame != nullptr) set_all_lanes(frame_lanes, *frame);
  FieldLanes field{
      motions.data(),
      {lanes::cast<LanePack>(samples[0].field(has_inertia).around.gravity), law_values.data(), has_inertia},
      slopes};
  if (frame != nullptr) field.carriers = field.observer = &frame_lanes;
  const auto n = static_cast<std::size_t>(num_unknowns(samples[0].element));
  std::vector<LanePack> residual(n), magnitude(n), tangent(n * n), alone(n);
  evaluate_lanes(e, field, multipliers.data(), turns, residual.data(), magnitude.data(), tangent.data());
  evaluate_lanes(e, field, multipliers.data(), turns, alone.data(), nullptr, nullptr);
  const auto numbers_of = [](const std::vector<LanePack>& a) {
    const auto* begin = reinterpret_cast<const double*>(a.data());
    return std::vector<double>(begin, begin + num_lanes * a.size());
  };
  EXPECT_EQ(numbers_of(residual), numbers_of(alone)) << "the same bits with and without a tangent";
  std::vector<LanePack> energies;
  if constexpr (has_energies<E>) {
    EnergiesOf<LanePack> all;
    eval_energies_lanes<E>(e, field, turns, all);
    energies = list_of(all);
  }
  return {numbers_of(residual), numbers_of(magnitude), numbers_of(tangent), numbers_of(energies)};
}
std::vector<double> lane_of(const std::vector<double>& a, std::size_t lane) {
  std::vector<double> r;
  for (std::size_t k = lane; k < a.size(); k += num_lanes) r.push_back(a[k]);
  return r;
}

const std::vector<std::pair<bool, Slopes>> settings = {{false, Slopes{}},
                                                       {true, Slopes{3.1, 7.3, false}},
                                                       {true, Slopes{0.0, 0.0, true}},
                                                       {true, Slopes{3.1, 7.3, false, 0.0, false, true, true}}};

TEST(ElementLanes, hold_the_bits_of_each_element_alone) {
  for_all_elements([](const auto& s) {
    SCOPED_TRACE(s.name);
    std::vector<std::decay_t<decltype(s)>> samples;
    for (unsigned k = 0; k < num_lanes; ++k) samples.push_back(varied(s, k));
    for (const auto& [has_inertia, slopes] : settings) {
      const LaneResult got = lane_results(samples, has_inertia, slopes);
      for (std::size_t lane = 0; lane < num_lanes; ++lane) {
        const Field field = samples[lane].field(has_inertia, slopes);
        const Evaluation alone = evaluation_of(samples[lane], field);
        std::vector<double> magnitude(alone.residual.size());
        eval_magnitude(samples[lane].element, field, alone.residual.data(), magnitude.data());
        EXPECT_EQ(lane_of(got.residual, lane), alone.residual) << "lane " << lane;
        EXPECT_EQ(lane_of(got.magnitude, lane), magnitude) << "lane " << lane;
        EXPECT_EQ(lane_of(got.tangent, lane), alone.tangent) << "lane " << lane;
        expect_same_energies(lane_of(got.energies, lane), energies_alone(samples[lane], field));
      }
    }
  });
}

/// All ports on the ground stand in the frame, and everything is described in it: more than one scene asks for.
TEST(ElementLanes, hold_the_same_bits_in_a_moving_frame) {
  CarrierMotion frame;
  frame.pose = motion::exp_se3(Vec6<double>{{0.4, -0.2, 0.3, 0.5, -0.7, 0.2}});
  frame.twist = Vec6<double>{{0.7, -1.1, 0.4, 1.3, -0.6, 0.9}};
  frame.twist_rate = Vec6<double>{{-0.3, 0.8, 0.5, -1.2, 0.2, 0.6}};
  for_all_elements([&](auto s) {
    SCOPED_TRACE(s.name);
    for (auto& port : s.element.ports)
      if (port.node == ground) port.carrier = 0;
    std::vector<std::decay_t<decltype(s)>> samples;
    for (unsigned k = 0; k < num_lanes; ++k) samples.push_back(varied(s, k));
    for (const auto& [has_inertia, slopes] : settings) {
      const LaneResult got = lane_results(samples, has_inertia, slopes, &frame);
      for (std::size_t lane = 0; lane < num_lanes; ++lane) {
        Field field = samples[lane].field(has_inertia, slopes);
        field.carriers = field.observer = &frame;
        const Evaluation alone = evaluation_of(samples[lane], field);
        std::vector<double> magnitude(alone.residual.size());
        eval_magnitude(samples[lane].element, field, alone.residual.data(), magnitude.data());
        EXPECT_EQ(lane_of(got.residual, lane), alone.residual) << "lane " << lane;
        EXPECT_EQ(lane_of(got.magnitude, lane), magnitude) << "lane " << lane;
        EXPECT_EQ(lane_of(got.tangent, lane), alone.tangent) << "lane " << lane;
        expect_same_energies(lane_of(got.energies, lane), energies_alone(samples[lane], field));
      }
    }
  });
}

TEST(ElementLanes, do_not_depend_on_their_neighbours_and_may_be_partly_filled) {
  for_all_elements([](const auto& s) {
    SCOPED_TRACE(s.name);
    std::vector<std::decay_t<decltype(s)>> samples, others;
    for (unsigned k = 0; k < num_lanes; ++k) samples.push_back(varied(s, k));
    for (unsigned k = 0; k < 3; ++k) others.push_back(k == 1 ? samples[1] : varied(s, 100 + k));
    const LaneResult full = lane_results(samples, true, Slopes{3.1, 7.3, false});
    const LaneResult part = lane_results(others, true, Slopes{3.1, 7.3, false});
    EXPECT_EQ(lane_of(full.residual, 1), lane_of(part.residual, 1));
    EXPECT_EQ(lane_of(full.tangent, 1), lane_of(part.tangent, 1));
    EXPECT_EQ(lane_of(part.tangent, 2), lane_of(part.tangent, 7)) << "lanes left over repeat the last";
    EXPECT_NE(lane_of(part.residual, 0), lane_of(part.residual, 2)) << "lanes have their own numbers";
  });
}

/// Terms that one lane has are evaluated for all; to the others they add nothing.
template <class E>
void expect_undamped_neighbours(const Sample<E>& damped) {
  SCOPED_TRACE(damped.name);
  std::vector<Sample<E>> samples;
  for (unsigned k = 0; k < num_lanes; ++k) samples.push_back(varied(k == 3 ? damped : undamped(damped), k));
  const Slopes slopes{3.1, 7.3, false};
  const LaneResult got = lane_results(samples, true, slopes);
  for (std::size_t lane = 0; lane < num_lanes; ++lane) {
    const Evaluation alone = evaluation_of(samples[lane], samples[lane].field(true, slopes));
    EXPECT_EQ(lane_of(got.residual, lane), alone.residual) << "lane " << lane;
    EXPECT_EQ(lane_of(got.tangent, lane), alone.tangent) << "lane " << lane;
  }
}
TEST(ElementLanes, without_dampers_are_not_changed_by_one_that_has_some) {
  for (const Ends ends : {Ends::plain, Ends::offset, Ends::grounded}) expect_undamped_neighbours(spring_sample(ends));
  for (const Sample<Joint>& s : joint_samples())
    if (s.element.num_efforts > 0) expect_undamped_neighbours(s);
}

TEST(ElementLanes, are_shared_by_elements_that_differ_in_numbers_only) {
  const auto plain = beam_sample<2>(Ends::plain).element, offset = beam_sample<2>(Ends::offset).element;
  EXPECT_TRUE(may_share_lanes(plain, varied(beam_sample<2>(Ends::plain), 5).element));
  EXPECT_FALSE(may_share_lanes(plain, offset));
  EXPECT_FALSE(may_share_lanes(plain, beam_sample<2>(Ends::grounded).element));
  EXPECT_FALSE(may_share_lanes(plain, beam_sample<2>(Ends::plain, false).element));
  EXPECT_FALSE(may_share_lanes(body_sample(false).element, point_sample(false).element));
  EXPECT_FALSE(may_share_lanes(point_load_sample(true).element, point_load_sample(false).element));
  auto carried = beam_sample<2>(Ends::grounded).element;
  for (auto& port : carried.ports)
    if (port.node == ground) port.carrier = 2;
  EXPECT_FALSE(may_share_lanes(carried, beam_sample<2>(Ends::grounded).element)) << "one stands in another frame";
  const std::vector<Sample<Joint>> joints = joint_samples();
  EXPECT_TRUE(may_share_lanes(joints[0].element, varied(joints[0], 5).element));
  for (std::size_t k = 1; k < joints.size(); ++k)
    EXPECT_FALSE(may_share_lanes(joints[0].element, joints[k].element)) << joints[k].name;
}

}  // namespace
}  // namespace bough::elements::check
