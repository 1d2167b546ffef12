#pragma once
/// The blend P(s) = s T(s d) T(d)^-1 = (1 - exp(-s D)) / (1 - exp(-D)) of the motions at both ends of a screw motion d,
/// D = ad(d): a section at s moves by (1 - P) times the motion of the first end plus P times that of the second. At the
/// two Gauss points s = 1/2 -+ t, P = 1/2 + p D -+ (t + q D^2), so both use the same odd and even part, with
///   p = (cos(t phi) - cos(phi/2)) / (2 phi sin(phi/2)),   q = (t - sin(t phi) / (2 sin(phi/2))) / phi^2,   X = phi^2.
#include "bough/motion/operators.hpp"

namespace bough::motion {

namespace detail {
/// p and q as functions of x = phi^2 have poles at (2 pi m)^2. Without the first two poles they are power series that
/// converge up to phi = 6 pi; 12 terms are exact to round-off up to phi = pi, the largest angle of a logarithm.
struct ScrewTable {
  std::array<long double, 2> residues;
  std::array<long double, 12> rest;
};
inline constexpr ScrewTable odd_blend{
    {1.5187629709611824621806134L, 3.7684109218818922858518997L},
    {0.0209988769198615526339449L, 0.0000318138957052796984803089L, 7.94628165565046662928443e-8L,
     2.15616326786947810124638e-10L, 5.97848694235726540281101e-13L, 1.67048229848213980332801e-15L,
     4.68359931302946668201376e-18L, 1.31543496914222814095686e-20L, 3.69796306293540832626472e-23L,
     1.04010720874203359870858e-25L, 2.92629124405304659985282e-28L, 8.23429411356230831602841e-31L}};
inline constexpr ScrewTable even_blend{
    {-0.30895786729576356028570327L, -0.074340983077791251868352282L},
    {0.000278010238671019160432184L, 0.000000747089901408131008365072L, 1.98529192772988594796169e-9L,
     5.34268517407206887045378e-12L, 1.45963831231043842411787e-14L, 4.03376535796645683857112e-17L,
     1.12311693278435635846513e-19L, 3.14134554605980604756551e-22L, 8.8098175507054453037877e-25L,
     2.47449645860616223229297e-27L, 6.95645805651753836801536e-30L, 1.95661689049767890641289e-32L}};

/// A coefficient and its first three derivatives by x; p, q: 1/(pole - x) of the first two poles.
template <class S>
lanes::Vec<S, 4> eval_screw_coefficient(const ScrewTable& table, const S& x, const S& p, const S& q) {
  using L = Literal<S>;
  S f(0.0), df(0.0), hf(0.0), tf(0.0);
  for (std::size_t n = table.rest.size(); n-- > 0;) {
    tf = multiply_add(tf, x, hf);
    hf = multiply_add(hf, x, df);
    df = multiply_add(df, x, f);
    f = multiply_add(f, x, S(static_cast<L>(table.rest[n])));
  }
  const L a = static_cast<L>(table.residues[0]), b = static_cast<L>(table.residues[1]);
  const S p1 = a * p, q1 = b * q, p2 = p1 * p, q2 = q1 * q, p3 = p2 * p, q3 = q2 * q;
  return {{f + p1 + q1, df + p2 + q2, L(2) * (hf + p3 + q3), L(6) * (tf + p3 * p + q3 * q)}};
}
}  // namespace detail

/// The offset t of the Gauss points s = 1/2 -+ t.
inline constexpr double gauss_offset = 0.288675134594812882254574390251;  // 1 / (2 sqrt(3))

/// p and q with their derivatives by X.
template <class G, class S>
struct ScrewBlend {
  typename G::template Number<S> p, dp, ddp, q, dq, ddq;
};
template <class G, class S>
BOUGH_INLINE ScrewBlend<G, S> eval_screw_blend(const typename G::template Motion<S>& d) {
  using L = Literal<S>;
  constexpr L pole1 = static_cast<L>(39.478417604357434475338L), pole2 = static_cast<L>(157.913670417429737901352L);
  const typename G::template Number<S> X = G::square(d);
  const S x = G::real(X), a = pole1 - x, b = pole2 - x, inverse = S(1.0) / (a * b), first = b * inverse,
          second = a * inverse;
  const auto p = detail::eval_screw_coefficient(detail::odd_blend, x, first, second);
  const auto q = detail::eval_screw_coefficient(detail::even_blend, x, first, second);
  ScrewBlend<G, S> f;
  f.p = G::number(X, p[0], p[1]);
  f.dp = G::number(X, p[1], p[2]);
  f.ddp = G::number(X, p[2], p[3]);
  f.q = G::number(X, q[0], q[1]);
  f.dq = G::number(X, q[1], q[2]);
  f.ddq = G::number(X, q[2], q[3]);
  return f;
}

}  // namespace bough::motion
