// Jacobians, inertia matrices and indices of one configuration after the other with Pinocchio; see contenders.py.

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/multibody.hpp>

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Rows = Eigen::Map<const RowMajor>;
using Matrix3n = Eigen::Matrix<double, 3, Eigen::Dynamic>;

struct Arm {
    pinocchio::Model model;
    pinocchio::Data data;
    pinocchio::FrameIndex tip;
    Eigen::VectorXd armature;
};

pinocchio::SE3 placement(const double *T) {
    const Rows matrix(T, 4, 4);
    return pinocchio::SE3(matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>());
}

// The six standard indices of A (3 x n), from the eigenvalues of A A^T in closed form: faster than any SVD.
void indices_of(const Matrix3n &A, double *values) {
    const Eigen::Matrix3d square = A * A.transpose();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(square, Eigen::EigenvaluesOnly);
    const Eigen::Vector3d squares = solver.eigenvalues().cwiseMax(std::numeric_limits<double>::min());
    const double root = std::cbrt(squares.prod());
    values[0] = std::sqrt(squares.prod());
    values[1] = std::sqrt(squares[0] / squares[2]);
    values[2] = std::sqrt(squares[0]);
    values[3] = root;
    values[4] = 1 / std::sqrt(squares.cwiseInverse().sum());
    values[5] = 3 * root / squares.sum();
}

}  // namespace

extern "C" {

// T: placements of the joints (n, 4, 4) in the frames before them, then that of the tip; inertia (n, 3, 3).
// Lives as long as the process.
void *make_arm(int n, const uint8_t *revolute, const double *T, const double *mass, const double *center,
               const double *inertia, const double *armature) {
    auto *arm = new Arm;
    pinocchio::JointIndex joint = 0;
    for (int i = 0; i < n; ++i) {
        const std::string name = "joint" + std::to_string(i);
        const auto place = placement(T + 16 * i);
        joint = revolute[i] ? arm->model.addJoint(joint, pinocchio::JointModelRZ(), place, name)
                            : arm->model.addJoint(joint, pinocchio::JointModelPZ(), place, name);
        const Eigen::Map<const Eigen::Vector3d> c(center + 3 * i);
        const Eigen::Matrix3d I = Rows(inertia + 9 * i, 3, 3);
        arm->model.appendBodyToJoint(joint, pinocchio::Inertia(mass[i], c, I), pinocchio::SE3::Identity());
    }
    const pinocchio::Frame frame("tip", joint, 0, placement(T + 16 * n), pinocchio::OP_FRAME);
    arm->tip = arm->model.addFrame(frame);
    arm->data = pinocchio::Data(arm->model);
    arm->armature = Eigen::Map<const Eigen::VectorXd>(armature, n);
    return arm;
}

// q (count, n); out, row after row: J (count, 3, n), M (count, n, n) where dynamic, values (count, 6 or 12).
void evaluate(void *handle, const double *q, int64_t count, int dynamic, double *J_out, double *M_out, double *values) {
    Arm &arm = *static_cast<Arm *>(handle);
    const int n = arm.model.nv;
    Eigen::VectorXd configuration(n);
    pinocchio::Data::Matrix6x J6 = pinocchio::Data::Matrix6x::Zero(6, n);
    Matrix3n J(3, n), A(3, n);
    Eigen::MatrixXd M(n, n), solved(n, 3);
    Eigen::LLT<Eigen::MatrixXd> cholesky(n);
    for (int64_t k = 0; k < count; ++k) {
        configuration = Eigen::Map<const Eigen::VectorXd>(q + k * n, n);
        pinocchio::computeJointJacobians(arm.model, arm.data, configuration);
        pinocchio::updateFramePlacement(arm.model, arm.data, arm.tip);
        pinocchio::getFrameJacobian(arm.model, arm.data, arm.tip, pinocchio::LOCAL_WORLD_ALIGNED, J6);
        J = J6.topRows<3>();
        Eigen::Map<RowMajor>(J_out + k * 3 * n, 3, n) = J;
        double *row = values + k * (dynamic ? 12 : 6);
        indices_of(J, row);
        if (dynamic) {
            pinocchio::crba(arm.model, arm.data, configuration);
            M = arm.data.M.selfadjointView<Eigen::Upper>();
            M.diagonal() += arm.armature;
            Eigen::Map<RowMajor>(M_out + k * n * n, n, n) = M;
            cholesky.compute(M);
            solved = J.transpose();
            cholesky.solveInPlace(solved);
            A = solved.transpose();
            indices_of(A, row + 6);
        }
    }
}
}
