// Pinocchio: J C J^T and deviation of given joint angles, as it is fastest in C++: headers only, for this processor.
//
// usage: pinocchio FOLDER [--quick]. Reads what armill-bench wrote; rows go to stdout, see bench/src/clock.rs. Exits 1
// if it is off the yardstick by more than 1e-6.

#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace pin = pinocchio;
using Joints = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// The arm and the loads of bench/src/workload.rs, m, rad, N.
constexpr double A1 = 0.155, A2 = -0.200, C1 = 0.450, C2 = 0.614, C3 = 0.640, LEVER = 0.250;
const Joints COMPLIANCE = (Joints() << 2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5).finished();
const Joints SIGNS = (Joints() << 1, 1, -1, -1, -1, -1).finished();
const Eigen::Vector3d NORMAL(-1, 0, 0);
const Eigen::Vector3d FORCES[4] = {{3, -5, -5}, {3, -5, 5}, {3, 5, -5}, {3, 5, 5}};
constexpr std::size_t BLOCK = 256;

struct Arm {
    pin::Model model;
    pin::FrameIndex tool;

    // The chain at joint positions zero: upper arm up, forearm to the front. Negative joints turn by the negative angle.
    Arm() {
        auto step = [](double x, double z) { return pin::SE3(Eigen::Matrix3d::Identity(), Eigen::Vector3d(x, 0, z)); };
        auto s = model.addJoint(0, pin::JointModelRZ(), step(0, C1), "S");
        auto l = model.addJoint(s, pin::JointModelRY(), step(A1, 0), "L");
        auto u = model.addJoint(l, pin::JointModelRY(), step(0, C2), "U");
        auto r = model.addJoint(u, pin::JointModelRX(), step(C3, -A2), "R");
        auto b = model.addJoint(r, pin::JointModelRY(), step(0, 0), "B");
        auto t = model.addJoint(b, pin::JointModelRX(), step(0, 0), "T");
        tool = model.addFrame(pin::Frame("tool", t, 0, step(LEVER, 0), pin::OP_FRAME));
    }

    Matrix6 jacobian(pin::Data& data, const Joints& q) const {
        Matrix6 J = Matrix6::Zero();
        pin::computeJointJacobians(model, data, q);
        pin::getFrameJacobian(model, data, tool, pin::LOCAL_WORLD_ALIGNED, J);
        return J;
    }

    Matrix6 compliance(pin::Data& data, const Joints& q) const {
        const Matrix6 J = jacobian(data, q);
        return J * COMPLIANCE.asDiagonal() * J.transpose();
    }

    double deviation(pin::Data& data, const Joints& q) const {
        const Matrix6 J = jacobian(data, q);
        const auto v = J.topRows<3>();
        double largest = 0;
        for (const auto& force : FORCES) {
            const Eigen::Vector3d delta = v * COMPLIANCE.cwiseProduct(v.transpose() * force);
            largest = std::max(largest, (delta - NORMAL * NORMAL.dot(delta)).norm());
        }
        return largest;
    }
};

std::vector<double> read(const std::string& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    std::vector<double> values(static_cast<std::size_t>(file.tellg()) / sizeof(double));
    file.seekg(0).read(reinterpret_cast<char*>(values.data()), values.size() * sizeof(double));
    return values;
}

double relative(const double* ours, const double* theirs, std::size_t count) {
    double apart = 0, scale = 0;
    for (std::size_t i = 0; i < count; ++i) {
        apart = std::max(apart, std::abs(ours[i] - theirs[i]));
        scale = std::max(scale, std::abs(theirs[i]));
    }
    return apart / scale;
}

// Million poses per second, in ascending order; the first round warms up.
std::vector<double> rates(const std::function<void()>& run, std::size_t count, int rounds) {
    std::vector<double> measured;
    for (int round = 0; round <= rounds; ++round) {
        const auto start = std::chrono::steady_clock::now();
        run();
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        if (round > 0) measured.push_back(1e-6 * count / seconds.count());
    }
    std::sort(measured.begin(), measured.end());
    return measured;
}

int main(int count_of_arguments, char** arguments) {
    if (count_of_arguments < 2) return 2;
    const std::string folder = arguments[1];
    const int rounds = count_of_arguments > 2 && !std::strcmp(arguments[2], "--quick") ? 3 : 15;
    const auto angles = read(folder + "/angles.f64"), deviations = read(folder + "/dev.f64"), matrices = read(folder + "/c66.f64");
    const Arm arm;
    pin::Data data(arm.model);
    std::vector<Joints> all(angles.size() / 6);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = SIGNS.cwiseProduct(Joints(angles.data() + 6 * i));

    double off = 0;
    for (std::size_t i = 0; 36 * i < matrices.size(); ++i) {
        const Matrix6 C = arm.compliance(data, all[i]);
        const double deviation = arm.deviation(data, all[i]);
        off = std::max({off, relative(C.data(), &matrices[36 * i], 36), relative(&deviation, &deviations[i], 1)});
    }
    std::fprintf(stderr, "Pinocchio: %.1e off the yardstick\n", off);
    if (!(off < 1e-6)) return 1;

    // Results of a block overwrite those of the block before: work is timed and not the RAM.
    std::vector<Matrix6> compliances(BLOCK);
    std::vector<double> results(BLOCK);
    const auto C66 = [&] { for (std::size_t i = 0; i < all.size(); ++i) compliances[i % BLOCK] = arm.compliance(data, all[i]); };
    const auto dev = [&] { for (std::size_t i = 0; i < all.size(); ++i) results[i % BLOCK] = arm.deviation(data, all[i]); };
    for (const auto& [work, run] : {std::pair<const char*, std::function<void()>>{"dev from angles", dev}, {"C66 from angles", C66}}) {
        const auto sorted = rates(run, all.size(), rounds);
        const auto at = [&](double quantile) { return sorted[static_cast<std::size_t>(std::lround(quantile * (sorted.size() - 1)))]; };
        std::printf("Pinocchio %s, C++\t%s\t1\t%.6f\t%.6f\t%.6f\tangles given; computeJointJacobians, then J C J^T; -O3 -march=native\n",
                    PINOCCHIO_VERSION, work, at(0.5), at(0.25), at(0.75));
    }
}
