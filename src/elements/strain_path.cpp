#include "bough/elements/strain_path.hpp"

#include <Eigen/LU>

namespace bough::elements {

namespace {

using Pack = LanePack;
using Mask = lanes::Mask<num_lanes>;

/// The second-order terms of smaller corrections are round-off.
constexpr double smallest_bend = 1e-9;
/// Relative to the length: changes of the slopes below the first value are round-off; changes below the second may be,
/// if they no longer shrink.
constexpr double round_off = 1e-15, near_round_off = 1e-12;
constexpr int most_sweeps = 40;
constexpr double far_off = 100.0;  ///< larger than any change on the path: the iteration diverges
/// For smaller c, exp(d)^-1 exp(d + c) equals exp(T(d + c / 2) c) to round-off, and this form keeps all digits of c.
constexpr double small_change = 1e-5;

/// Index of a node among the nodes other than the reference node.
template <int N>
constexpr int place_of(int node) {
  return node < Beam<N>::reference ? node : node - 1;
}

/// Values of d at the nodes and at the strain points from its slopes at the strain points; d is zero at the reference
/// node.
template <int N>
struct FromSlopes {
  double node[N - 1][N - 1], point[N - 1][N - 1];

  FromSlopes() {
    const auto& rule = strain_rule<N>();
    Eigen::Matrix<double, N - 1, N - 1> slope, shape;
    for (int g = 0; g < N - 1; ++g)
      for (int i = 0; i < N; ++i)
        if (i != Beam<N>::reference) {
          slope(g, place_of<N>(i)) = rule.slope[g][i];
          shape(g, place_of<N>(i)) = rule.shape[g][i];
        }
    const Eigen::Matrix<double, N - 1, N - 1> inverse = slope.inverse(), at_points = shape * inverse;
    for (int i = 0; i < N - 1; ++i)
      for (int g = 0; g < N - 1; ++g) {
        node[i][g] = inverse(i, g);
        point[i][g] = at_points(i, g);
      }
  }
};
template <int N>
const FromSlopes<N>& from_slopes() {
  static const FromSlopes<N> table;
  return table;
}

template <int N>
Vec6<Pack> sum(const double (&weight)[N - 1], const Vec6<Pack>* x) {
  Vec6<Pack> r = weight[0] * x[0];
  for (int g = 1; g < N - 1; ++g) r += weight[g] * x[g];
  return r;
}

/// Values and slopes at the strain points of a field with these values at the nodes.
template <int N>
void at_strain_points(const Vec6<Pack>* nodes, Vec6<Pack>* values, Vec6<Pack>* slopes) {
  const auto& rule = strain_rule<N>();
  for (int g = 0; g < N - 1; ++g) {
    values[g] = slopes[g] = Vec6<Pack>::zero();
    for (int i = 0; i < N; ++i)
      if (i != Beam<N>::reference) {
        values[g] += rule.shape[g][i] * nodes[place_of<N>(i)];
        slopes[g] += rule.slope[g][i] * nodes[place_of<N>(i)];
      }
  }
}

/// Square of the largest magnitude of vectors; lengths are divided by a length whose inverse square is given.
template <int N>
Pack square_of(const Vec6<Pack>* x, const Pack& by_length) {
  Pack most(0.0);
  for (int g = 0; g < N - 1; ++g) {
    const Vec3<Pack> u = lanes::linear_part(x[g]), psi = lanes::angular_part(x[g]);
    const Pack square = by_length * lanes::dot(u, u) + lanes::dot(psi, psi);
    most = select(less(most, square), square, most);
  }
  return most;
}

/// Repeats x <- next(x) in lanes that are active until their changes are round-off; returns the lanes that do not
/// converge.
template <int N, class Next>
Mask substitute(Mask active, const Pack& by_length, Vec6<Pack>* x, Next&& next) {
  Pack last(1e300);
  Mask lost = active & !active;
  for (int k = 0; k < most_sweeps && lanes::any(active); ++k) {
    Vec6<Pack> now[N - 1], change[N - 1];
    next(x, now);
    for (int g = 0; g < N - 1; ++g) change[g] = now[g] - x[g];
    const Pack size = square_of<N>(change, by_length);
    const Mask diverges = active & !less(size, Pack(far_off * far_off));
    lost = lost | diverges;
    active = active & !diverges;
    for (int g = 0; g < N - 1; ++g) x[g] = select(active, now[g], x[g]);
    const Mask stays = less(Pack(0.25) * last, size) & less(size, Pack(near_round_off * near_round_off));
    active = active & !(less(size, Pack(round_off * round_off)) | stays);
    last = size;
  }
  return lost | active;
}

/// Slopes of d at the strain points for given strains, starting from nearby slopes; lanes without a solution keep
/// these. Returns the active lanes with a solution.
template <int N>
Mask solve_strains(const Vec6<Pack>* strains, const Mask& active, const Pack& by_length, Vec6<Pack>* slopes) {
  Vec6<Pack> near[N - 1];
  for (int g = 0; g < N - 1; ++g) near[g] = slopes[g];
  const Mask lost = substitute<N>(active, by_length, slopes, [&](const Vec6<Pack>* x, Vec6<Pack>* now) {
    for (int g = 0; g < N - 1; ++g)
      now[g] = motion::inverse_tangent_times(sum<N>(from_slopes<N>().point[g], x), strains[g]);
  });
  for (int g = 0; g < N - 1; ++g) slopes[g] = select(lost, near[g], slopes[g]);
  return active & !lost;
}

/// exp(d)^-1 exp(d + change); H = exp(d).
SectionWay<Pack> way_between(const Frame<Pack>& H, const Vec6<Pack>& d, const Vec6<Pack>& change) {
  SectionWay<Pack> way;
  way.end = d + change;
  const Vec3<Pack> turn = lanes::angular_part(change);
  const Mask is_small = less(lanes::dot(turn, turn), Pack(small_change * small_change));
  const Frame<Pack> S = motion::relative(H, motion::exp_se3(way.end));
  const motion::Quaternion<Pack> q = motion::quaternion_of(S.R);
  const Vec6<Pack> eta = motion::tangent_times(Vec6<Pack>(d + Pack(0.5) * change), change);
  const motion::Quaternion<Pack> near = motion::exp_quaternion(lanes::angular_part(eta));
  way.turn = {select(is_small, near.w, q.w), select(is_small, near.v, q.v)};
  way.shift = select(is_small, motion::exp_se3(eta).x, S.x);
  return way;
}

}  // namespace

template <int N>
void eval_strain_path(const PortMotion<Pack>* ports, const Vec6<Pack>* eta, const Pack& factor, SectionWay<Pack>* ways,
                      Vec6<Pack>* strain_rates) {
  constexpr int r = Beam<N>::reference;
  const BeamShape<Pack, N> shape = eval_shape<Pack, N>(ports);
  Vec6<Pack> d[N - 1], correction[N - 1], change[N - 1];
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    const int k = place_of<N>(i);
    d[k] = shape.d[i];
    correction[k] = shape.inverse[i].times(eta[i] - motion::inverse_adjoint_times(shape.relative[i], eta[r]));
    change[k] = factor * correction[k];
  }
  if constexpr (N == 2) {
    strain_rates[0] = correction[0];
  } else {
    Vec6<Pack> value[N - 1], slope[N - 1], by_value[N - 1], by_slope[N - 1], strain[N - 1];
    at_strain_points<N>(d, value, slope);
    at_strain_points<N>(correction, by_value, by_slope);
    for (int g = 0; g < N - 1; ++g) {
      const auto T = motion::tangent_operator(value[g]);
      strain_rates[g] = T.times(by_slope[g]) + T.slope_times(by_value[g], slope[g]);
      strain[g] = T.times(slope[g]) + factor * strain_rates[g];
      slope[g] += factor * by_slope[g];
    }
    const Vec3<Pack> along = lanes::linear_part(slope[0]);
    const Pack by_length = Pack(1.0) / lanes::dot(along, along);
    const Mask bends = less(Pack(smallest_bend * smallest_bend), square_of<N>(change, by_length));
    const Mask follows = solve_strains<N>(strain, bends, by_length, slope), is_linear = bends & !follows;
    if (lanes::any(is_linear))
      for (int g = 0; g < N - 1; ++g) {
        const auto T = motion::tangent_operator(Vec6<Pack>(value[g] + factor * by_value[g]));
        strain_rates[g] =
            select(is_linear, Vec6<Pack>(T.times(by_slope[g]) + T.slope_times(by_value[g], slope[g])), strain_rates[g]);
      }
    for (int k = 0; k < N - 1; ++k)
      change[k] = select(follows, Vec6<Pack>(sum<N>(from_slopes<N>().node[k], slope) - d[k]), change[k]);
  }
  for (int i = 0; i < N; ++i)
    if (i != r) ways[place_of<N>(i)] = way_between(shape.relative[i], d[place_of<N>(i)], change[place_of<N>(i)]);
}

template <int N>
void eval_strain_path_twists(const Vec6<Pack>* ends, const Vec6<Pack>* strain_rates, Vec6<Pack>* twists) {
  if constexpr (N == 2) {
    twists[0] = motion::tangent_times(ends[0], strain_rates[0]);
  } else {
    Vec6<Pack> value[N - 1], slope[N - 1], rate[N - 1];
    at_strain_points<N>(ends, value, slope);
    motion::MotionOperator<Pack> T[N - 1], inverse[N - 1];
    for (int g = 0; g < N - 1; ++g) {
      T[g] = motion::tangent_operator(value[g]);
      inverse[g] = motion::inverse_tangent_operator(value[g]);
      rate[g] = inverse[g].times(strain_rates[g]);
    }
    const Vec3<Pack> along = lanes::linear_part(slope[0]);
    const Pack by_length = Pack(1.0) / lanes::dot(along, along), square = square_of<N>(rate, by_length);
    const Mask moves = less(Pack(0.0), square);
    const Pack size = sqrt(select(moves, square, Pack(1.0))), by_size = Pack(1.0) / size;
    for (int g = 0; g < N - 1; ++g) rate[g] = by_size * rate[g];
    substitute<N>(moves, by_length, rate, [&](const Vec6<Pack>* x, Vec6<Pack>* now) {
      for (int g = 0; g < N - 1; ++g)
        now[g] = inverse[g].times(by_size * strain_rates[g] -
                                  T[g].slope_times(sum<N>(from_slopes<N>().point[g], x), slope[g]));
    });
    for (int k = 0; k < N - 1; ++k)
      twists[k] = motion::tangent_times(ends[k], Vec6<Pack>(size * sum<N>(from_slopes<N>().node[k], rate)));
  }
}

template void eval_strain_path<2>(const PortMotion<Pack>*, const Vec6<Pack>*, const Pack&, SectionWay<Pack>*,
                                  Vec6<Pack>*);
template void eval_strain_path<3>(const PortMotion<Pack>*, const Vec6<Pack>*, const Pack&, SectionWay<Pack>*,
                                  Vec6<Pack>*);
template void eval_strain_path<4>(const PortMotion<Pack>*, const Vec6<Pack>*, const Pack&, SectionWay<Pack>*,
                                  Vec6<Pack>*);
template void eval_strain_path_twists<2>(const Vec6<Pack>*, const Vec6<Pack>*, Vec6<Pack>*);
template void eval_strain_path_twists<3>(const Vec6<Pack>*, const Vec6<Pack>*, Vec6<Pack>*);
template void eval_strain_path_twists<4>(const Vec6<Pack>*, const Vec6<Pack>*, Vec6<Pack>*);

}  // namespace bough::elements
