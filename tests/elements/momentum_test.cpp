/// Momenta and forces of elements against the complex step of their discrete action.
#include "bough/elements/momentum.hpp"

#include <gtest/gtest.h>

#include "elements/check_element.hpp"

namespace bough::elements::check {
namespace {

constexpr double exact = 2e-13;   // round-off of the terms, which are of order one
constexpr double elastic = 0.07;  // tau [s^2]

/// Potential of gravity of a mass given by its 6x6 mass in a frame.
template <class S>
S potential_of(const Mat6<double>& mass, double w, const Frame<S>& H, const Vec3<S>& gravity) {
  const Vec3<double> moment{{mass(5, 1), mass(3, 2), mass(4, 0)}};
  return S(-w) * lanes::dot(gravity, Vec3<S>(mass(0, 0) * H.x + H.R * lanes::cast<S>(moment)));
}

template <class S>
S lagrangian_of(const RigidBody& e, const PortMotion<S>* p, const Surroundings<S>& around) {
  return kinetic_energy_of(e, p) - potential_of<S>(e.mass, 1.0, p[0].H, around.gravity);
}
template <class S, int N>
S lagrangian_of(const Beam<N>& e, const PortMotion<S>* p, const Surroundings<S>& around) {
  const BeamShape<S, N> b = eval_shape<S, N>(p);
  Vec6<S> rate[N];
  eval_shape_rates<S, N>(b, p, rate);
  S sum = kinetic_energy_of(e, p) - strain_energy_of(e, p);
  const auto& rule = strain_rule<N>();
  for (int g = 0; g < Beam<N>::num_strain_points; ++g) {  // rates of strain, L e' = T y' + (T along d') y
    const auto T = motion::tangent_operator(blend<S, N>(rule.shape[g], b.d));
    const Vec6<S> stretched = T.times(blend<S, N>(rule.slope[g], rate)) +
                              T.slope_times(blend<S, N>(rule.shape[g], rate), blend<S, N>(rule.slope[g], b.d));
    sum = sum + S(0.5 * elastic * rule.weight[g] / e.length) * lanes::dot(stretched, Vec6<S>(e.stiffness * stretched));
  }
  const PortMotion<S>& r = p[Beam<N>::reference];
  for (int g = 0; g < N; ++g) {
    const auto m = section_at<S, N>(mass_rule<N>().shape[g], b, rate, p);
    sum = sum - potential_of<S>(e.mass, mass_rule<N>().weight[g] * e.length, motion::compose(r.H, m.relative),
                                around.gravity);
  }
  return sum;
}
template <class S>
S lagrangian_of(const Bushing& e, const PortMotion<S>* p, const Surroundings<S>& around) {
  const Frame<S> relative = motion::relative(p[0].H, p[1].H);
  const Vec6<S> rate = motion::inverse_tangent_times(motion::Se3::log(relative),
                                                     Vec6<S>(p[1].v - motion::inverse_adjoint_times(relative, p[0].v)));
  return 0.5 * elastic * lanes::dot(rate, Vec6<S>(e.stiffness * rate)) - eval_strain_energy(e, p, around.laws);
}
template <class S>
S lagrangian_of(const Spring& e, const PortMotion<S>* p, const Surroundings<S>&) {
  return -eval_strain_energy(e, p);
}

/// h L at the middle of a step from H_n by D, the ports of node k moved by the complex step eta at the step's start
/// or end.
template <class E>
Complex action_of(const Sample<E>& s, const std::vector<Vec6<double>>& D, double h, int node,
                  const Vec6<Complex>& before, const Vec6<Complex>& after) {
  const motion::Vec3Pair anchor = anchor_of(s.element, s.nodes.data());
  std::vector<NodeState<Complex>> states = states_of<Complex>(s.nodes, anchor);
  for (std::size_t n = 0; n < states.size(); ++n) {
    Frame<Complex> H0 = states[n].H, H1 = motion::compose(H0, motion::exp_se3(lanes::cast<Complex>(D[n])));
    if (static_cast<int>(n) == node) {
      H0 = motion::compose(H0, motion::exp_se3(before));
      H1 = motion::compose(H1, motion::exp_se3(after));
    }
    const Vec6<Complex> d = motion::log_se3(motion::relative(H0, H1));
    states[n].H = motion::compose(H0, motion::exp_se3(Vec6<Complex>(Complex(0.5) * d)));
    states[n].v = Complex(1.0 / h) * d;
  }
  const std::vector<Complex> laws = complex_of(s.laws);
  const Surroundings<Complex> around{lanes::cast<Complex>(s.field(true).around.gravity), laws.data(), true};
  return Complex(h) * lagrangian_of(s.element, ports_of(s.element, states, anchor.hi).data(), around);
}

template <class E>
void expect_momenta(Sample<E> s) {
  SCOPED_TRACE(s.name);
  const double h = 0.6;  // turns of half a radian in the step: nothing is small
  Numbers numbers(7);
  std::vector<Vec6<double>> D;
  Sample<E> middle = s;
  for (NodeMotion& n : middle.nodes) {
    D.push_back(numbers.vec6(0.4));
    const Frame<double> half = motion::exp_se3(0.5 * D.back());
    n.x.add(n.R * half.x);
    n.R = n.R * half.R;
    n.v = (1.0 / h) * D.back();
  }
  const auto size = static_cast<std::size_t>(6 * s.nodes.size());
  std::vector<double> P(size), F(size), P_alone(size);
  evaluate_momentum(middle.element, middle.field(true), 0.0, elastic, P.data(), F.data());
  evaluate_momentum(middle.element, middle.field(true), 0.0, elastic, P_alone.data(), nullptr);
  EXPECT_EQ(P, P_alone);
  std::vector<double> got, want;
  std::size_t at = 0;
  for (const Port& port : s.element.ports) {
    if (port.node == ground) continue;
    Vec6<double> P_node, F_node;
    for (int i = 0; i < 6; ++i, ++at) {
      P_node[i] = P[at];
      F_node[i] = F[at];
    }
    const Vec6<double>& d = D[static_cast<std::size_t>(port.node)];
    const Vec6<double> before = eval_momentum_after<motion::Se3, double>(-d, -h, P_node, F_node),
                       after = eval_momentum_after<motion::Se3, double>(d, h, P_node, F_node);
    const Vec6<Complex> none = Vec6<Complex>::zero();
    for (int i = 0; i < 6; ++i) {
      const Vec6<Complex> eta = Complex(0.0, complex_step) * Vec6<Complex>::unit(i);
      got.push_back(before[i]);
      want.push_back(-action_of(s, D, h, port.node, eta, none).imag() / complex_step);
      got.push_back(after[i]);
      want.push_back(action_of(s, D, h, port.node, none, eta).imag() / complex_step);
    }
  }
  EXPECT_LE(relative_error(got, want), exact);
  EXPECT_GT(largest(want), 0.05);
}

TEST(Momentum, of_bodies_is_the_derivative_of_the_discrete_action) {
  expect_momenta(body_sample(false));
  expect_momenta(body_sample(true));
}
TEST(Momentum, of_beams_is_the_derivative_of_the_discrete_action) {
  for (const Ends ends : {Ends::plain, Ends::offset, Ends::grounded}) {
    expect_momenta(beam_sample<2>(ends, true, false));
    expect_momenta(beam_sample<3>(ends, true, false));
    expect_momenta(beam_sample<4>(ends, true, false));
    auto massless = beam_sample<3>(ends, false, false);
    massless.element.mass = Mat6<double>::zero();
    expect_momenta(massless);
  }
}
TEST(Momentum, of_couplings_is_the_derivative_of_the_discrete_action) {
  for (const Ends ends : {Ends::plain, Ends::offset, Ends::grounded}) {
    for (auto bushing : {bushing_sample(ends), driven_bushing_sample(ends)}) {
      bushing.element.has_damping = false;
      expect_momenta(bushing);
    }
    auto spring = spring_sample(ends);
    spring.element.damping = 0.0;
    expect_momenta(spring);
  }
}

/// The elastic inertia's part of momenta is linear in the twists of the nodes: it is its matrix times them.
template <class E>
void expect_elastic_matrix(const Sample<E>& s) {
  SCOPED_TRACE(s.name);
  const auto size = static_cast<std::size_t>(6 * s.nodes.size());
  std::vector<double> with(size), without(size), matrix(size * size), product(size);
  evaluate_momentum(s.element, s.field(true), 0.0, elastic, with.data(), nullptr);
  evaluate_momentum(s.element, s.field(true), 0.0, 0.0, without.data(), nullptr);
  add_elastic_mass(s.element, s.field(true), elastic, matrix.data());
  for (std::size_t i = 0; i < size; ++i) {
    with[i] -= without[i];
    for (std::size_t j = 0; j < size; ++j)
      product[i] += matrix[size * i + j] * s.nodes[j / 6].v[static_cast<int>(j % 6)];
  }
  EXPECT_LE(relative_error(product, with), exact);
  EXPECT_GT(largest(with), 1e-3);
}
TEST(Momentum, of_the_elastic_inertia_is_its_matrix_times_the_twists) {
  for (const Ends ends : {Ends::plain, Ends::offset, Ends::grounded}) {
    expect_elastic_matrix(beam_sample<2>(ends));
    expect_elastic_matrix(beam_sample<3>(ends));
    expect_elastic_matrix(beam_sample<4>(ends));
    expect_elastic_matrix(bushing_sample(ends));
  }
}

/// The blocks of the nodes of a beam whose nodes share one twist add up to the block of a body of its mass.
template <int N>
void expect_shared_mass() {
  Sample<Beam<N>> beam = beam_sample<N>(Ends::plain);
  Sample<RigidBody> body = body_sample(false);
  body.element.mass = beam.element.length * beam.element.mass;
  for (NodeMotion& n : beam.nodes) n.v = body.nodes[0].v;
  std::vector<double> nodes(static_cast<std::size_t>(36 * N * N)), whole(36), sum(36);
  add_gyroscopic(beam.element, beam.field(true), 0.7, nodes.data());
  add_gyroscopic(body.element, body.field(true), 0.7, whole.data());
  for (std::size_t i = 0; i < 6 * N; ++i)
    for (std::size_t j = 0; j < 6 * N; ++j) {
      if (i / 6 == j / 6)
        sum[6 * (i % 6) + j % 6] += nodes[6 * N * i + j];
      else
        EXPECT_EQ(nodes[6 * N * i + j], 0.0);
    }
  EXPECT_LE(relative_error(sum, whole), exact);
  EXPECT_GT(largest(whole), 0.1);
}
TEST(Momentum, gyroscopic_blocks_of_a_beam_share_out_its_mass) {
  expect_shared_mass<2>();
  expect_shared_mass<3>();
  expect_shared_mass<4>();
}

}  // namespace
}  // namespace bough::elements::check
