/* Kinematics and collisions of many configurations: 1 where a pair of geoms penetrates. */
#include <mujoco/mujoco.h>

int blocked(const mjModel* m, mjData* d, const double* q, int count, unsigned char* out) {
  int total = 0;
  for (int i = 0; i < count; i++) {
    for (int k = 0; k < m->nq; k++) d->qpos[k] = q[i * m->nq + k];
    mj_kinematics(m, d);
    mj_collision(m, d);
    out[i] = 0;
    for (int c = 0; c < d->ncon; c++) out[i] |= d->contact[c].dist < 0;
    total += out[i];
  }
  return total;
}
