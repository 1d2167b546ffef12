#pragma once
/// Elements of every type in general position: curved and twisted references, coupled sections, offsets, ports on the
/// ground. All magnitudes are near one, so that one tolerance holds for forces and moments alike.
#include <algorithm>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bough/elements/evaluate.hpp"

namespace bough::elements::check {

using Taylor1 = lanes::Taylor<double, 1>;
using Taylor3 = lanes::Taylor<double, 3>;

/// Numbers in [-1, 1] from a fixed seed.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}
  double next(double scale = 1.0) { return scale * std::uniform_real_distribution<double>(-1.0, 1.0)(engine_); }
  Vec3<double> vec3(double scale = 1.0) { return {{next(scale), next(scale), next(scale)}}; }
  /// Linear part first: the order of arguments of one call would be the compiler's, and with it the samples.
  Vec6<double> vec6(double scale = 1.0) { return vec6(scale, scale); }
  Frame<double> frame(double distance = 1.0, double angle = 1.5) { return motion::exp_se3(vec6(distance, angle)); }
  /// Symmetric positive definite, eigenvalues of order one, all entries coupled.
  Mat6<double> definite() {
    Mat6<double> a;
    for (double& x : a.m) x = next(0.5);
    return lanes::transpose_times(a, a) + Mat6<double>::identity();
  }

 private:
  Vec6<double> vec6(double linear, double angular) {
    const Vec3<double> first = vec3(linear);
    return lanes::join(first, vec3(angular));
  }
  std::mt19937_64 engine_;
};

inline Port port_at(int node) {
  Port p;
  p.node = node;
  return p;
}
inline Port port_at(int node, const Frame<double>& offset) {
  Port p;
  p.node = node;
  p.has_offset = true;
  p.offset = offset;
  return p;
}
/// The inverse of port placement: where the node must be for the port to be at H.
inline Frame<double> node_pose(const Port& port, const Frame<double>& H) {
  return port.has_offset ? motion::compose(H, motion::inverse(port.offset)) : H;
}

/// An element with everything that its evaluation reads.
template <class E>
struct Sample {
  std::string name;
  E element;
  std::vector<NodeMotion> nodes;
  std::vector<double> laws = {0.7, -0.4, 1.3}, law_rates = {0.5, 0.3, -0.8};
  std::vector<double> multipliers;
  double turns = 0.0;

  Field field(bool has_inertia, Slopes slopes = {}) const {
    return {nodes.data(), {Vec3<double>{{0.3, -0.8, 0.5}}, laws.data(), has_inertia}, slopes};
  }
};

inline NodeMotion moving(const Frame<double>& H, Numbers& numbers) {
  NodeMotion n{H.R, motion::Vec3Pair::from(H.x), numbers.vec6(), numbers.vec6(), numbers.vec6(0.4), {}};
  n.drift = -1.7 * lanes::linear_part(n.a);
  return n;
}

/// Puts nodes under the ports so that port k is at poses[k]; ports on the ground take the pose as their offset.
template <class E>
void place(Sample<E>& s, const std::vector<Frame<double>>& poses, Numbers& numbers) {
  for (std::size_t k = 0; k < poses.size(); ++k) {
    Port& port = s.element.ports[k];
    if (port.node == ground) {
      port.offset = poses[k];
      continue;
    }
    const auto n = static_cast<std::size_t>(port.node);
    if (s.nodes.size() <= n) s.nodes.resize(n + 1);
    s.nodes[n] = moving(node_pose(port, poses[k]), numbers);
  }
}

/// Poses of a helix of body strain e, at equidistant parameters, then disturbed.
inline std::vector<Frame<double>> helix(int n, double length, const Vec6<double>& e, double disturbance,
                                        Numbers& numbers) {
  const Frame<double> start = numbers.frame();
  std::vector<Frame<double>> r;
  for (int k = 0; k < n; ++k) {
    const Frame<double> regular = motion::compose(start, motion::exp_se3(Vec6<double>((k * length / (n - 1)) * e)));
    r.push_back(motion::compose(regular, motion::exp_se3(numbers.vec6(disturbance))));
  }
  return r;
}

inline std::vector<PortMotion<double>> still(const std::vector<Frame<double>>& poses) {
  std::vector<PortMotion<double>> p;
  for (const Frame<double>& H : poses) p.push_back({H, Vec6<double>::zero(), Vec6<double>::zero()});
  return p;
}

enum class Ends { plain, offset, grounded };

/// Curved, twisted, shear-prestrained reference of 1.3 m, coupled section with mass and damping, far from equilibrium.
template <int N>
Sample<Beam<N>> beam_sample(Ends ends, bool has_mass = true, bool has_damping = true) {
  Numbers numbers(100 + N);
  Sample<Beam<N>> s;
  s.name = "beam of " + std::to_string(N) + " nodes, ends " + std::to_string(static_cast<int>(ends));
  Beam<N>& b = s.element;
  b.length = 1.3;
  b.stiffness = numbers.definite();
  b.mass = make_mass_matrix(1.3, numbers.vec3(0.3), Mat3<double>{{0.9, 0.1, -0.2, 0.1, 0.4, 0.1, -0.2, 0.1, 0.6}});
  b.damping = numbers.definite();
  b.has_mass = has_mass;
  b.has_damping = has_damping;
  const Vec6<double> e{{1.0, 0.05, -0.02, 0.6, -0.4, 0.8}};
  set_reference(b, still(helix(N, b.length, e, 0.05, numbers)).data());
  for (int k = 0; k < N; ++k) b.ports[k] = port_at(k);
  if (ends == Ends::offset) {
    b.ports[0] = port_at(0, numbers.frame(0.3));
    b.ports[N - 1] = port_at(N - 1, numbers.frame(0.3));
  }
  if (ends == Ends::grounded)
    for (int k = 0; k < N; ++k) b.ports[k] = k == 0 ? Port{} : port_at(k - 1);
  place(s, helix(N, b.length, Vec6<double>{{1.1, -0.1, 0.1, -0.5, 0.9, 0.3}}, 0.15, numbers), numbers);
  return s;
}

template <int N>
Sample<LineLoad<N>> line_load_sample(bool follows, Ends ends) {
  Numbers numbers(200 + N);
  Sample<LineLoad<N>> s;
  s.name = (follows ? "follower" : "dead") + std::string(" line load of ") + std::to_string(N) + " nodes";
  LineLoad<N>& q = s.element;
  q.length = 1.3;
  q.wrench = numbers.vec6();
  q.follows = follows;
  q.law = 2;
  for (int k = 0; k < N; ++k) q.ports[k] = port_at(k);
  if (ends == Ends::offset) q.ports[1] = port_at(1, numbers.frame(0.3));
  if (ends == Ends::grounded) q.ports[N - 1] = Port{};
  place(s, helix(N, q.length, Vec6<double>{{1.1, -0.1, 0.1, -0.5, 0.9, 0.3}}, 0.15, numbers), numbers);
  return s;
}

inline Sample<RigidBody> body_sample(bool offset) {
  Numbers numbers(300);
  Sample<RigidBody> s;
  s.name = "rigid body";
  s.element.mass = make_mass_matrix(1.7, Vec3<double>{{0.2, -0.3, 0.5}},
                                    Mat3<double>{{1.1, 0.1, 0.2, 0.1, 0.9, -0.1, 0.2, -0.1, 1.3}});
  s.element.ports[0] = offset ? port_at(0, numbers.frame(0.4)) : port_at(0);
  place(s, {numbers.frame()}, numbers);
  return s;
}

/// A mass at the origin of its port's frame alone.
inline Sample<RigidBody> point_sample(bool offset) {
  Sample<RigidBody> s = body_sample(offset);
  s.name = "point mass";
  s.element.mass = make_mass_matrix(1.7, Vec3<double>::zero(), Mat3<double>::zero());
  s.element.is_point = true;
  return s;
}

inline Sample<PointLoad> point_load_sample(bool follows) {
  Numbers numbers(310);
  Sample<PointLoad> s;
  s.name = follows ? "follower load" : "dead load";
  s.element.wrench = numbers.vec6();
  s.element.follows = follows;
  s.element.law = 1;
  s.element.ports[0] = port_at(0, numbers.frame(0.4));
  place(s, {numbers.frame()}, numbers);
  return s;
}

/// Ports of a coupling: plain, with offsets on both, or the first on the ground.
inline void set_ports(Port* ports, Ends ends, Numbers& numbers) {
  ports[0] = port_at(0);
  ports[1] = port_at(1);
  if (ends == Ends::offset) {
    ports[0] = port_at(0, numbers.frame(0.4));
    ports[1] = port_at(1, numbers.frame(0.4));
  }
  if (ends == Ends::grounded) {
    ports[0] = Port{};
    ports[1] = port_at(0, numbers.frame(0.4));
  }
}

inline Sample<Spring> spring_sample(Ends ends) {
  Numbers numbers(320);
  Sample<Spring> s;
  s.name = "spring, ends " + std::to_string(static_cast<int>(ends));
  s.element.stiffness = 1.4;
  s.element.rest_length = 0.2;  // below the length of every sample: at 0.6 one of them was all but unstrained
  s.element.damping = 0.8;
  set_ports(s.element.ports, ends, numbers);
  place(s, {numbers.frame(), numbers.frame()}, numbers);
  return s;
}

inline Sample<Bushing> bushing_sample(Ends ends) {
  Numbers numbers(330);
  Sample<Bushing> s;
  s.name = "bushing, ends " + std::to_string(static_cast<int>(ends));
  s.element.stiffness = numbers.definite();
  s.element.damping = numbers.definite();
  s.element.has_damping = true;
  s.element.rest = numbers.vec6(0.3);
  set_ports(s.element.ports, ends, numbers);
  const Frame<double> first = numbers.frame();
  place(s, {first, motion::compose(first, numbers.frame(0.8, 1.0))}, numbers);
  return s;
}

/// Its stiffness is multiplied by a law above 0.
inline Sample<Bushing> driven_bushing_sample(Ends ends) {
  Sample<Bushing> s = bushing_sample(ends);
  s.name += ", with a factor";
  s.element.factor = 2;
  return s;
}

/// A coupling of the catalogue with any numbers that its kind allows, drawn until it is strained.
template <IsCatalogued E>
Sample<E> catalogued_sample(Ends ends) {
  constexpr unsigned first_seed = 350, most_draws = 10000;
  for (unsigned seed = first_seed; seed < first_seed + most_draws; ++seed) {
    Numbers numbers(seed);
    Sample<E> s;
    s.name = std::string(E::words.name) + ", ends " + std::to_string(static_cast<int>(ends));
    std::vector<double> values;
    std::vector<int> laws;
    for (const scene::CouplingField& field : kind_of<E>.fields) {
      if (field.type == scene::CouplingFieldType::law) {
        laws.push_back(2);  // above 0
      } else if (field.type == scene::CouplingFieldType::matrix) {
        const Mat6<double> matrix = numbers.definite();
        values.insert(values.end(), std::begin(matrix.m), std::end(matrix.m));
      } else {
        for (std::size_t i = 0; i < field.count(); ++i)
          values.push_back(field.type == scene::CouplingFieldType::number
                               ? std::max(field.low, -1.0) + 0.8 + numbers.next(0.5)
                               : numbers.next());
      }
    }
    take_data(s.element, values.data(), Mat3<double>::identity(), laws.data());
    take_start(s.element, Frame<double>::identity());
    set_ports(s.element.ports, ends, numbers);
    const Frame<double> first = numbers.frame(), second = numbers.frame();
    place(s, {first, second}, numbers);
    const PortMotion<double> at[2] = {{first, {}, {}}, {second, {}, {}}};
    double energy = 0.0;
    if constexpr (requires { eval_strain_energy(s.element, at, s.laws.data()); })
      energy = eval_strain_energy(s.element, at, s.laws.data());
    else
      energy = eval_strain_energy(s.element, at);
    if (energy > 0.5) return s;
  }
  throw std::runtime_error(std::string(E::words.name) + ": no sample is strained");
}

inline ConstraintRow row_of(RowKind kind, int i = 0, int j = 0, int law = -1, double constant = 0.0) {
  ConstraintRow r;
  r.kind = kind;
  r.i = i;
  r.j = j;
  r.law = law;
  r.constant = constant;
  return r;
}

/// A joint with given rows, off its constraints; with efforts of both kinds when asked.
inline Sample<Joint> joint_sample(const std::string& name, const std::vector<ConstraintRow>& rows, bool has_efforts,
                                  Ends ends) {
  Numbers numbers(340);
  Sample<Joint> s;
  s.name = name + ", ends " + std::to_string(static_cast<int>(ends));
  Joint& joint = s.element;
  joint.num_rows = static_cast<int>(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    joint.rows[k] = rows[k];
    s.multipliers.push_back(numbers.next());
  }
  if (has_efforts) {
    joint.num_efforts = 2;
    joint.efforts[0] = {RowKind::angle, 0.9, 0.2, 0.6, 1};
    joint.efforts[1] = {RowKind::along, 1.2, -0.3, 0.5, -1};
  }
  set_ports(joint.ports, ends, numbers);
  const Frame<double> first = numbers.frame();
  place(s, {first, motion::compose(first, numbers.frame(0.8, 0.9))}, numbers);
  s.turns = 6.1;  // nearly one turn counted: the present angle lies within half a turn of it
  return s;
}

/// Every joint worth a test: each row kind alone, all along and across rows, full joints, efforts with and without
/// rows.
inline std::vector<Sample<Joint>> joint_samples() {
  using K = RowKind;
  std::vector<Sample<Joint>> r;
  const std::vector<ConstraintRow> along = {row_of(K::along, 0), row_of(K::along, 1, 0, 0), row_of(K::along, 2)};
  const std::vector<ConstraintRow> revolute = {along[0], along[1], along[2], row_of(K::across, 0, 2),
                                               row_of(K::across, 1, 2)};
  std::vector<ConstraintRow> motor = revolute, screw = revolute;
  motor.push_back(row_of(K::angle, 0, 0, 1));
  screw[2] = row_of(K::screw, 0, 0, 2, 0.17);
  for (const Ends ends : {Ends::plain, Ends::offset, Ends::grounded}) {
    r.push_back(joint_sample("displacements", along, false, ends));
    r.push_back(joint_sample("motor", motor, false, ends));
    r.push_back(joint_sample("screw with efforts", screw, true, ends));
    r.push_back(joint_sample("efforts only", {}, true, ends));
    r.push_back(joint_sample("rod", {row_of(K::distance, 0, 0, -1, 0.7)}, false, ends));
    r.push_back(
        joint_sample("driven rod and hinge", {row_of(K::distance, 0, 0, 0), row_of(K::across, 0, 2)}, true, ends));
    r.push_back(joint_sample("effort along a rod", {}, true, ends));
    r.back().element.efforts[1].coordinate = K::distance;
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r.push_back(joint_sample("across " + std::to_string(i) + std::to_string(j), {row_of(K::across, i, j)}, false,
                               Ends::offset));
  return r;
}

/// The same without dampers.
inline Sample<Spring> undamped(Sample<Spring> s) {
  s.name += ", undamped";
  s.element.damping = 0.0;
  return s;
}
inline Sample<Bushing> undamped(Sample<Bushing> s) {
  s.name += ", undamped";
  s.element.has_damping = false;
  return s;
}
inline Sample<Joint> undamped(Sample<Joint> s) {
  s.name += ", undamped";
  for (int k = 0; k < s.element.num_efforts; ++k) s.element.efforts[k].damping = 0.0;
  return s;
}

/// Without the one number whose absence leaves no forces that depend on velocities.
template <IsCatalogued E>
Sample<E> undamped(Sample<E> s) {
  s.name += ", undamped";
  if (!looks_at_rates(s.element)) return s;
  const auto leave_out = [&](const auto& datum) {
    if constexpr (std::decay_t<decltype(datum)>::type == scene::CouplingFieldType::number) {
      const double value = std::exchange(s.element.*datum.member, 0.0);
      if (looks_at_rates(s.element)) s.element.*datum.member = value;
      return !looks_at_rates(s.element);
    }
    return false;
  };
  std::apply([&](const auto&... data) { static_cast<void>((leave_out(data) || ...)); }, E::declared());
  return s;
}

/// Calls check(sample) for all elements of all kinds.
template <class Check>
void for_all_beams(const Check& check) {
  for (const Ends ends : {Ends::plain, Ends::offset, Ends::grounded}) {
    check(beam_sample<2>(ends));
    check(beam_sample<3>(ends));
    check(beam_sample<4>(ends));
  }
}
template <class Check>
void for_all_couplings(const Check& check) {
  for (const Ends ends : {Ends::plain, Ends::offset, Ends::grounded}) {
    check(spring_sample(ends));
    check(undamped(spring_sample(ends)));
    check(bushing_sample(ends));
    check(driven_bushing_sample(ends));
    for_each_catalogued([&]<class E>() {
      check(catalogued_sample<E>(ends));
      check(undamped(catalogued_sample<E>(ends)));
    });
  }
}
template <class Check>
void for_all_loads(const Check& check) {
  for (const bool follows : {false, true}) {
    check(point_load_sample(follows));
    for (const Ends ends : {Ends::plain, Ends::offset, Ends::grounded}) {
      check(line_load_sample<2>(follows, ends));
      check(line_load_sample<3>(follows, ends));
      check(line_load_sample<4>(follows, ends));
    }
  }
}
template <class Check>
void for_all_elements(const Check& check) {
  for_all_beams(check);
  for_all_couplings(check);
  for_all_loads(check);
  check(body_sample(false));
  check(body_sample(true));
  check(point_sample(false));
  check(point_sample(true));
  for (const Sample<Joint>& s : joint_samples()) {
    check(s);
    if (s.element.num_efforts > 0) check(undamped(s));
  }
}

}  // namespace bough::elements::check
