// What every system of rigid transformations here has in common, so that interpolation, blending and
// regression are written once: DualComplex in the plane, DualQuaternion in space.
#pragma once

#include <concepts>

namespace probewarp {

/// A unit element is a rigid transformation; p and -p are the same one. Sums and multiples of them are
/// elements of the ring around the group.
template <class P>
concept RigidTransformation = requires(const P p, const P q, const typename P::Scalar t,
                                       const typename P::Point v, const typename P::Log x) {
    { p* q } -> std::same_as<P>;                       // first q, then p
    { inverse(p) } -> std::same_as<P>;                 // of a unit
    { act(p, v) } -> std::same_as<typename P::Point>;  // of a unit
    { exp(x) } -> std::same_as<P>;                     // a unit
    { log(p) } -> std::same_as<typename P::Log>;       // of a unit
    { p + q } -> std::same_as<P>;
    { -p } -> std::same_as<P>;
    { t* p } -> std::same_as<P>;
    { normalised(p) } -> std::same_as<P>;  // requires a part that turns other than 0
    { rotation_dot(p, q) } -> std::same_as<typename P::Scalar>;
    { x + x } -> std::same_as<typename P::Log>;
    { t* x } -> std::same_as<typename P::Log>;
    {coordinates(x)};  // std::array of 3 or 6 numbers
};

/// exp(t log(q p^-1)) p: from p at t = 0 to q at t = 1 at constant speed. In the plane SLERP (MKO section
/// 5.1), in space ScLERP (Kavan section 3.3). Along the turn from p to q as it stands: q and -q are reached
/// on different ways.
template <RigidTransformation P>
P slerp(const P& p, const P& q, typename P::Scalar t) {
    return exp(t * log(q * inverse(p))) * p;
}

}  // namespace probewarp
