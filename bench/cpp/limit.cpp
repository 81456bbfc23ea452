// Upper bound of the speed. The work of armill's lanes written by hand for AVX-512 and for this one arm, branch and
// plane: intrinsics, constants compiled in, everything in registers, two vectors of eight poses at once. In addition the
// arithmetic of that work alone: no memory, no dependencies. The speed of the lanes is compared with both.
//
// usage: limit FOLDER [--quick]. Reads what armill-bench wrote; rows go to stdout, see bench/src/clock.rs. Exits 1 if
// it is off the yardstick by more than 1e-9.

#include <cstdio>

#ifndef __AVX512DQ__
int main() { std::printf("skipped\tC++ by hand\tthis processor has no AVX-512\n"); }
#else

#include <immintrin.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

// The arm and the loads of bench/src/workload.rs, m, rad, N; heights are relative to axis 2.
constexpr double A1 = 0.155, A2 = -0.200, C1 = 0.450, L2 = 0.614, C3 = 0.640, LEVER = 0.250;
constexpr double COMPLIANCE[6] = {2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5};
constexpr double FORCES[4][3] = {{3, -5, -5}, {3, -5, 5}, {3, 5, -5}, {3, 5, 5}};
// Middle and half of each joint's range, tested by cosines: cos(phi - middle) >= cos(half). Joints 4 and 6 turn freely.
constexpr double MIDDLE[3] = {0, 0.5672, 0.7007}, HALF[3] = {2.9670, 2.1380, 2.0508}, BEND = 2.3562;
// Squared lengths and sines below it are treated as zero; sine of 1 deg.
constexpr double NOTHING = 1e-20, NEAR = 0.017452406437283512, VERIFIED = 1e-9;
// Results of a block overwrite those of the block before.
constexpr std::size_t BLOCK = 256;

struct V {
    __m512d v;
    V(__m512d v) : v(v) {}
    V(double x) : v(_mm512_set1_pd(x)) {}
    V() = default;
};
#define INLINE static inline __attribute__((always_inline))
INLINE V operator+(V a, V b) { return _mm512_add_pd(a.v, b.v); }
INLINE V operator-(V a, V b) { return _mm512_sub_pd(a.v, b.v); }
INLINE V operator*(V a, V b) { return _mm512_mul_pd(a.v, b.v); }
INLINE V operator/(V a, V b) { return _mm512_div_pd(a.v, b.v); }
INLINE __mmask8 operator<(V a, V b) { return _mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ); }
INLINE V root(V a) { return _mm512_sqrt_pd(a.v); }
INLINE V size(V a) { return _mm512_abs_pd(a.v); }
INLINE V most(V a, V b) { return _mm512_max_pd(a.v, b.v); }
INLINE V least(V a, V b) { return _mm512_min_pd(a.v, b.v); }
INLINE V sum(V a, V b, V c) { return _mm512_fmadd_pd(a.v, b.v, c.v); }         // a b + c
INLINE V difference(V a, V b, V c) { return _mm512_fmsub_pd(a.v, b.v, c.v); }  // a b - c
INLINE V rest(V a, V b, V c) { return _mm512_fnmadd_pd(a.v, b.v, c.v); }       // c - a b
INLINE V either(__mmask8 condition, V yes, V no) { return _mm512_mask_blend_pd(condition, no.v, yes.v); }
INLINE V flagged(V flags, __mmask8 condition, double bit) { return _mm512_mask_add_pd(flags.v, condition, flags.v, V(bit).v); }

struct Vector { V x, y, z; };
INLINE Vector cross(Vector a, Vector b) {
    return {difference(a.y, b.z, a.z * b.y), difference(a.z, b.x, a.x * b.z), difference(a.x, b.y, a.y * b.x)};
}
INLINE V dot(Vector a, Vector b) { return sum(a.x, b.x, sum(a.y, b.y, a.z * b.z)); }

// K vectors side by side, to hide the latency of each.
#define EACH _Pragma("GCC unroll 4") for (int k = 0; k < K; ++k)

template <int K> struct Solved {
    Vector t[K], z4[K], n[K];
    V c1[K], s1[K], cp[K], sp[K], cc[K], sc[K], per_n2[K], n2[K], flags[K];
};

// Front, elbow up; links verified, reach and singularities flagged.
template <int K> INLINE void solve(const double* const at[3], std::size_t i, Solved<K>& s) {
    const double L3 = std::sqrt(A2 * A2 + C3 * C3);
    V r[K], u[K], h2[K], d2[K], across[K];
    Vector p[K];
    EACH {
        s.t[k] = {_mm512_loadu_pd(at[0] + i + 8 * k), _mm512_loadu_pd(at[1] + i + 8 * k), _mm512_loadu_pd(at[2] + i + 8 * k)};
        s.t[k].z = s.t[k].z - C1;
        p[k] = {s.t[k].x - LEVER, s.t[k].y, s.t[k].z};
        h2[k] = sum(p[k].x, p[k].x, p[k].y * p[k].y);
        r[k] = root(h2[k]);
        s.flags[k] = flagged(0.0, r[k] < V(NEAR * (L2 + L3)), 128);
    }
    EACH {
        u[k] = r[k] - A1;
        d2[k] = sum(u[k], u[k], p[k].z * p[k].z);
        const V stretched = V((L2 + L3) * (L2 + L3)) - d2[k], folded = d2[k] - (L2 - L3) * (L2 - L3);
        across[k] = either(u[k] < V(0.0), -0.5 / L2, 0.5 / L2) * root(most(stretched * folded, 0.0));
        s.flags[k] = flagged(s.flags[k], stretched < V(0.0), 1);
        s.flags[k] = flagged(s.flags[k], folded < V(0.0), 2);
        s.flags[k] = flagged(s.flags[k], size(across[k]) < V(NEAR * L3), 64);
    }
    EACH {
        const __mmask8 on_axis = h2[k] < V(NOTHING), on_shoulder = d2[k] < V(NOTHING);
        const V h = most(h2[k], NOTHING), d = most(d2[k], NOTHING), quotient = V(1.0) / (h * d), per_h = d * quotient, per_d = h * quotient;
        const V k1 = sum(d, 0.5 / L2, (L2 * L2 - L3 * L3) * 0.5 / L2), v = p[k].z;
        s.c1[k] = either(on_axis, 1.0, r[k] * p[k].x * per_h);
        s.s1[k] = either(on_axis, 0.0, r[k] * p[k].y * per_h);
        s.cp[k] = either(on_shoulder, 1.0, sum(v, k1, u[k] * across[k]) * per_d);
        s.sp[k] = either(on_shoulder, 0.0, difference(u[k], k1, v * across[k]) * per_d);
        s.cc[k] = rest(L2, s.cp[k], v) * (1 / L3);
        s.sc[k] = rest(L2, s.sp[k], u[k]) * (1 / L3);
        const auto off = [](V c, V s) __attribute__((always_inline)) { return sum(c, c, difference(s, s, 1.0)); };
        const V arm = off(s.c1[k], s.s1[k]), upper = off(s.cp[k], s.sp[k]), fore = off(s.cc[k], s.sc[k]);
        s.flags[k] = flagged(s.flags[k], V(VERIFIED * VERIFIED) < sum(arm, arm, sum(upper, upper, fore * fore)), 8);
    }
    EACH {
        // Axis 4 is in the arm's plane and perpendicular to the wrist offset.
        const V x = sum(s.cc[k], -A2 / L3, s.sc[k] * (C3 / L3)), z = sum(s.cc[k], C3 / L3, s.sc[k] * (A2 / L3));
        s.z4[k] = {s.c1[k] * x, s.s1[k] * x, z};
        s.n[k] = cross(s.z4[k], {1.0, 0.0, 0.0});
        s.n2[k] = dot(s.n[k], s.n[k]);
        s.per_n2[k] = V(1.0) / most(s.n2[k], NOTHING);
        s.flags[k] = flagged(s.flags[k], s.n2[k] < V(NOTHING), 16);
        s.flags[k] = flagged(s.flags[k], s.n2[k] < V(NEAR * NEAR), 32);
    }
}

// Levers turned about the axes: z_i x (p - o_i), number 5 times the sine of the wrist's bend.
template <int K> INLINE void levers(const Solved<K>& s, int k, Vector v[6]) {
    const Vector t = s.t[k], lever = {LEVER, 0.0, 0.0};
    const V out = sum(s.c1[k], t.x, s.s1[k] * t.y), up = rest(L2, s.cp[k], t.z);
    v[0] = {V(0.0) - t.y, t.x, 0.0};
    v[1] = {s.c1[k] * t.z, s.s1[k] * t.z, V(A1) - out};
    v[2] = {s.c1[k] * up, s.s1[k] * up, sum(L2, s.sp[k], A1) - out};
    v[3] = cross(s.z4[k], lever);
    v[4] = cross(s.n[k], lever);
    v[5] = {0.0, 0.0, 0.0};  // The tool is on axis 6.
}

template <int K> __attribute__((noinline)) void dev(const double* const at[3], std::size_t count, double* in_plane, double* state) {
    for (std::size_t i = 0; i < count; i += 8 * K) {
        Solved<K> s;
        solve(at, i, s);
        EACH {
            const V ce = sum(s.cc[k], s.cp[k], s.sc[k] * s.sp[k]), se = difference(s.sc[k], s.cp[k], s.cc[k] * s.sp[k]);
            const auto room = [](int joint, V c, V s) __attribute__((always_inline)) {
                return sum(c, std::cos(MIDDLE[joint]), sum(s, std::sin(MIDDLE[joint]), -std::cos(HALF[joint])));
            };
            const V arm = least(least(room(0, s.c1[k], s.s1[k]), room(1, s.cp[k], s.sp[k])), room(2, ce, se));
            s.flags[k] = flagged(s.flags[k], least(arm, s.z4[k].x - std::cos(BEND)) < V(0.0), 256 + 512);
        }
        EACH {
            Vector v[6];
            levers(s, k, v);
            // In-plane rows y and z of the compliance.
            V xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
            _Pragma("GCC unroll 6") for (int j = 0; j < 5; ++j) {
                const V c = j == 4 ? V(COMPLIANCE[4]) * s.per_n2[k] : V(COMPLIANCE[j]);
                const V y = c * v[j].y, z = c * v[j].z;
                xy = sum(y, v[j].x, xy), xz = sum(z, v[j].x, xz), yy = sum(y, v[j].y, yy), yz = sum(y, v[j].z, yz), zz = sum(z, v[j].z, zz);
            }
            V largest = -1.0, which = 0.0;
            _Pragma("GCC unroll 4") for (int j = 0; j < 4; ++j) {
                const auto [x, y, z] = FORCES[j];
                const V along_y = sum(xy, x, sum(yy, y, yz * z)), along_z = sum(xz, x, sum(yz, y, zz * z));
                const V square = sum(along_y, along_y, along_z * along_z);
                const __mmask8 more = largest < square;
                largest = either(more, square, largest), which = either(more, 1024.0 * j, which);
            }
            _mm512_storeu_pd(in_plane + i + 8 * k, root(largest).v);
            _mm512_storeu_pd(state + i + 8 * k, (which + s.flags[k]).v);
        }
    }
}

// Upper triangle row by row, then the flags: 22 arrays of BLOCK.
template <int K> __attribute__((noinline)) void c66(const double* const at[3], std::size_t count, double* out) {
    for (std::size_t i = 0; i < count; i += 8 * K) {
        Solved<K> s;
        solve(at, i, s);
        EACH {
            Vector v[6];
            levers(s, k, v);
            const Vector across = {V(0.0) - s.s1[k], s.c1[k], 0.0};
            const Vector axes[6] = {{0.0, 0.0, 1.0}, across, across, s.z4[k], s.n[k], {1.0, 0.0, 0.0}};
            V c[21];
            for (V& entry : c) entry = 0.0;
            _Pragma("GCC unroll 6") for (int j = 0; j < 6; ++j) {
                const V compliance = j == 4 ? V(COMPLIANCE[4]) * s.per_n2[k] : V(COMPLIANCE[j]);
                const V screw[6] = {v[j].x, v[j].y, v[j].z, axes[j].x, axes[j].y, axes[j].z};
                int entry = 0;
                _Pragma("GCC unroll 6") for (int row = 0; row < 6; ++row) {
                    const V weighed = compliance * screw[row];
                    _Pragma("GCC unroll 6") for (int column = row; column < 6; ++column, ++entry) c[entry] = sum(weighed, screw[column], c[entry]);
                }
            }
            _Pragma("GCC unroll 21") for (int entry = 0; entry < 21; ++entry) _mm512_storeu_pd(out + entry * BLOCK + i + 8 * k, c[entry].v);
            _mm512_storeu_pd(out + 21 * BLOCK + i + 8 * k, s.flags[k].v);
        }
    }
}

// The number of roots, quotients and other operations of a vector above (counted in the compiled loops), all
// independent.
template <int ROOTS, int QUOTIENTS, int OTHERS> __attribute__((noinline)) double alone(std::size_t vectors) {
    constexpr int LANES = 12;
    V a[LANES], slow[5];
    for (V& x : a) { x = 1.0; asm volatile("" : "+v"(x.v)); }
    for (V& x : slow) { x = 1.3; asm volatile("" : "+v"(x.v)); }
    const V most = 0.999999, little = 1e-6;
    for (std::size_t i = 0; i < vectors; ++i) {
        _Pragma("GCC unroll 5") for (int k = 0; k < ROOTS; ++k) slow[k] = root(slow[k]);
        _Pragma("GCC unroll 5") for (int k = ROOTS; k < ROOTS + QUOTIENTS; ++k) slow[k] = little / slow[k];
        _Pragma("GCC unroll 400") for (int k = 0; k < OTHERS; ++k) a[k % LANES] = sum(a[k % LANES], most, little);
    }
    V all = 0.0;
    for (V x : a) all = all + x;
    for (V x : slow) all = all + x;
    return _mm512_reduce_add_pd(all.v);
}

std::vector<double> read(const std::string& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    std::vector<double> values(static_cast<std::size_t>(file.tellg()) / sizeof(double));
    file.seekg(0).read(reinterpret_cast<char*>(values.data()), values.size() * sizeof(double));
    return values;
}

int main(int count_of_arguments, char** arguments) {
    if (count_of_arguments < 2) return 2;
    const std::string folder = arguments[1];
    const int rounds = count_of_arguments > 2 && !std::strcmp(arguments[2], "--quick") ? 3 : 15;
    const auto poses = read(folder + "/poses.f64"), deviations = read(folder + "/dev.f64"), matrices = read(folder + "/c66.f64");
    // Whole blocks; what is left over is less than one in a thousand.
    const std::size_t count = deviations.size() / BLOCK * BLOCK;
    std::vector<double> places[3];
    for (int axis = 0; axis < 3; ++axis)
        for (std::size_t i = 0; i < count; ++i) places[axis].push_back(poses[12 * i + 4 * axis + 3]);
    std::vector<double> in_plane(BLOCK), state(BLOCK), out(22 * BLOCK);
    const auto at = [&](std::size_t first, const double* from[3]) { for (int axis = 0; axis < 3; ++axis) from[axis] = places[axis].data() + first; };

    double off = 0;
    const double* from[3];
    for (std::size_t first = 0; first < count; first += BLOCK) {
        at(first, from);
        dev<2>(from, BLOCK, in_plane.data(), state.data());
        for (std::size_t i = 0; i < BLOCK; ++i) off = std::max(off, std::abs(in_plane[i] / deviations[first + i] - 1));
    }
    for (std::size_t first = 0; 36 * (first + BLOCK) <= matrices.size(); first += BLOCK) {
        at(first, from);
        c66<2>(from, BLOCK, out.data());
        for (std::size_t i = 0; i < BLOCK; ++i) {
            const double* C = &matrices[36 * (first + i)];
            const double scale = std::abs(*std::max_element(C, C + 36));
            for (int row = 0, entry = 0; row < 6; ++row)
                for (int column = row; column < 6; ++column, ++entry)
                    off = std::max(off, std::abs(out[entry * BLOCK + i] - C[6 * row + column]) / scale);
        }
    }
    std::fprintf(stderr, "C++ by hand: %.1e off the yardstick\n", off);
    if (!(off < 1e-9)) return 1;

    // Long enough for the processor to settle on its clock for wide vectors.
    constexpr int REPEATED = 10;
    const auto over_all = [&](auto work) {
        return [&, work] {
            const double* from[3];
            for (int turn = 0; turn < REPEATED; ++turn)
                for (std::size_t first = 0; first < count; first += BLOCK) { at(first, from); work(from); }
        };
    };
    struct Candidate { const char *who, *work, *note; std::function<void()> run; std::vector<double> rates; };
    Candidate candidates[] = {
        {"C++ by hand, AVX-512", "dev", "this arm, branch and plane compiled in; as flagged as lanes", over_all([&](const double* const* from) { dev<2>(from, BLOCK, in_plane.data(), state.data()); }), {}},
        {"C++ by hand, AVX-512", "C66", "this arm and branch compiled in; as flagged as lanes", over_all([&](const double* const* from) { c66<2>(from, BLOCK, out.data()); }), {}},
        {"arithmetic alone, AVX-512", "dev", "3 roots, 2 quotients, 180 sums and products a vector, that wait for nothing", [&] { in_plane[0] = alone<3, 2, 180>(REPEATED * count / 8); }, {}},
        {"arithmetic alone, AVX-512", "C66", "2 roots, 2 quotients, 233 sums and products a vector, that wait for nothing", [&] { in_plane[0] = alone<2, 2, 233>(REPEATED * count / 8); }, {}},
    };
    for (int round = 0; round <= rounds; ++round)
        for (Candidate& candidate : candidates) {
            const auto start = std::chrono::steady_clock::now();
            candidate.run();
            const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
            if (round > 0) candidate.rates.push_back(1e-6 * REPEATED * count / seconds.count());
        }
    for (Candidate& candidate : candidates) {
        std::sort(candidate.rates.begin(), candidate.rates.end());
        const auto at = [&](double quantile) { return candidate.rates[static_cast<std::size_t>(std::lround(quantile * (candidate.rates.size() - 1)))]; };
        std::printf("%s\t%s\t1\t%.6f\t%.6f\t%.6f\t%s\n", candidate.who, candidate.work, at(0.5), at(0.25), at(0.75), candidate.note);
    }
}
#endif
