// Self-collisions of many configurations with coal, after MuJoCo's kinematics: 1 where a pair of geoms penetrates.

#include <coal/collision.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>
#include <mujoco/mujoco.h>

#include <memory>
#include <stdexcept>
#include <vector>

namespace {

using Geometry = std::shared_ptr<coal::CollisionGeometry>;

struct Pair {
    int a, b;
    double reach;  // of the balls about both
    coal::ComputeCollision collide;
};

struct World {
    std::vector<Geometry> shapes;
    std::vector<Pair> pairs;
};

// In the frame of MuJoCo's geom, whose sizes are half lengths.
Geometry shape_of(const mjModel *m, int geom) {
    const mjtNum *size = m->geom_size + 3 * geom;
    switch (m->geom_type[geom]) {
        case mjGEOM_SPHERE:
            return std::make_shared<coal::Sphere>(size[0]);
        case mjGEOM_CAPSULE:
            return std::make_shared<coal::Capsule>(size[0], 2 * size[1]);
        case mjGEOM_CYLINDER:
            return std::make_shared<coal::Cylinder>(size[0], 2 * size[1]);
        case mjGEOM_BOX:
            return std::make_shared<coal::Box>(2 * size[0], 2 * size[1], 2 * size[2]);
        case mjGEOM_ELLIPSOID:
            return std::make_shared<coal::Ellipsoid>(size[0], size[1], size[2]);
        case mjGEOM_MESH:
            break;
        default:
            return nullptr;
    }
    const int mesh = m->geom_dataid[geom], count = m->mesh_vertnum[mesh];
    const float *vertex = m->mesh_vert + 3 * m->mesh_vertadr[mesh];
    auto points = std::make_shared<std::vector<coal::Vec3s>>(count);
    for (int i = 0; i < count; ++i) (*points)[i] = {vertex[3 * i], vertex[3 * i + 1], vertex[3 * i + 2]};
    return Geometry(coal::ConvexBase::convexHull(points, count, true));
}

coal::Transform3s placed(const mjData *d, int geom) {
    using Turn = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    return {Eigen::Map<const Turn>(d->geom_xmat + 9 * geom), Eigen::Map<const coal::Vec3s>(d->geom_xpos + 3 * geom)};
}

}  // namespace

extern "C" {

// Pairs (count, 2) of geoms; nullptr where one has a shape that is not here. Lives as long as the process.
void *make_world(const mjModel *m, const int *pairs, int count) {
    auto *world = new World;
    world->shapes.resize(m->ngeom);
    for (int i = 0; i < 2 * count; ++i) {
        auto &shape = world->shapes[pairs[i]];
        if (!shape && !(shape = shape_of(m, pairs[i]))) return nullptr;
        shape->computeLocalAABB();
    }
    for (int i = 0; i < count; ++i) {
        const int a = pairs[2 * i], b = pairs[2 * i + 1];
        const double reach = m->geom_rbound[a] + m->geom_rbound[b];
        world->pairs.push_back({a, b, reach, {world->shapes[a].get(), world->shapes[b].get()}});
    }
    return world;
}

void blocked(const World *world, const mjModel *m, mjData *d, const double *q, int count, unsigned char *out) {
    coal::CollisionRequest request;
    request.enable_contact = false;
    coal::CollisionResult result;
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < m->nq; ++k) d->qpos[k] = q[i * m->nq + k];
        mj_kinematics(m, d);
        out[i] = 0;
        for (const Pair &pair : world->pairs) {
            const coal::Transform3s T_a = placed(d, pair.a), T_b = placed(d, pair.b);
            if ((T_a.getTranslation() - T_b.getTranslation()).squaredNorm() > pair.reach * pair.reach) continue;
            result.clear();
            if (pair.collide(T_a, T_b, request, result)) {
                out[i] = 1;
                break;
            }
        }
    }
}
}
