/*
 * boxes.cpp: a heap of boxes by Bullet (https://pybullet.org), in double precision, for bench/boxes.sh.
 *
 *   boxes STEPS DT MU ITERATIONS < "half sides and density", then a line "x y z  w i j k  size" a box
 *
 * Boxes lie between the planes x = 0, x = 1, y = 0, y = 1 and z = 0 under gravity along -z. Of the last
 * step it prints "seconds of CPU a step (the last tenth of the steps)  kinetic energy  residual", the
 * residual as boxes.sh has it, and then a line "x y z  w i j k" a box.
 */
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

static btRigidBody *add(btDiscreteDynamicsWorld &world, double mass, btCollisionShape *shape,
                        const btTransform &at, double mu)
{
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, new btDefaultMotionState(at), shape, inertia);
    info.m_friction = std::sqrt(mu); // of a pair it takes the product
    info.m_restitution = 0;
    auto *body = new btRigidBody(info);
    body->setActivationState(DISABLE_DEACTIVATION);
    body->setDamping(0, 0);
    world.addRigidBody(body);
    return body;
}

/* |r - proj(r - m (u + mu |u_t| n), K)|, K Coulomb's cone */
static double natural(const btVector3 &r, const btVector3 &u, const btVector3 &n, double mu, double m)
{
    btVector3 ut = u - u.dot(n) * n, tau = r - m * (u + mu * ut.length() * n);
    double tn = tau.dot(n);
    btVector3 tt = tau - tn * n, p = tau;
    double t = tt.length();
    if (mu * t <= -tn)
        p = btVector3(0, 0, 0);
    else if (t > mu * tn) {
        double pn = (tn + mu * t) / (1 + mu * mu);
        p = pn * n + (mu * pn / t) * tt;
    }
    return (r - p).length();
}

static double residual(btDiscreteDynamicsWorld &world, double mu, double mass, double dt)
{
    double most = 0;
    for (int k = 0; k < world.getDispatcher()->getNumManifolds(); k++) {
        const btPersistentManifold *m = world.getDispatcher()->getManifoldByIndexInternal(k);
        const auto *a = btRigidBody::upcast(m->getBody0()), *b = btRigidBody::upcast(m->getBody1());
        for (int j = 0; j < m->getNumContacts(); j++) {
            const btManifoldPoint &p = m->getContactPoint(j);
            if (p.getDistance() > 0 && p.m_appliedImpulse == 0) continue;
            btVector3 n = p.m_normalWorldOnB, x = p.getPositionWorldOnB(); // from b to a
            btVector3 u = a->getVelocityInLocalPoint(x - a->getCenterOfMassPosition()) -
                          b->getVelocityInLocalPoint(x - b->getCenterOfMassPosition());
            btVector3 r = p.m_appliedImpulse * n + p.m_appliedImpulseLateral1 * p.m_lateralFrictionDir1 +
                          p.m_appliedImpulseLateral2 * p.m_lateralFrictionDir2;
            most = std::fmax(most, natural(r, u, n, mu, mass));
        }
    }
    return most / (mass * 9.81 * dt);
}

int main(int argc, char **argv)
{
    if (argc != 5) return 64;
    const int steps = std::atoi(argv[1]);
    const double dt = std::atof(argv[2]), mu = std::atof(argv[3]);
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
    world.setGravity(btVector3(0, 0, -9.81));
    world.getSolverInfo().m_numIterations = std::atoi(argv[4]);
    const double wall[5][4] = { { 1, 0, 0, 0 }, { -1, 0, 0, -1 }, { 0, 1, 0, 0 }, { 0, -1, 0, -1 }, { 0, 0, 1, 0 } };
    for (const auto &w : wall)
        add(world, 0, new btStaticPlaneShape(btVector3(w[0], w[1], w[2]), w[3]), btTransform::getIdentity(), mu);
    double hx, hy, hz, density, x, y, z, qw, qx, qy, qz, size, total = 0;
    if (std::scanf("%lf %lf %lf %lf", &hx, &hy, &hz, &density) != 4) return 65;
    std::vector<btRigidBody *> box;
    while (std::scanf("%lf %lf %lf %lf %lf %lf %lf %lf", &x, &y, &z, &qw, &qx, &qy, &qz, &size) == 8) {
        auto *shape = new btBoxShape(size * btVector3(hx, hy, hz));
        shape->setMargin(1e-3 * size * hx);
        double mass = 8 * hx * hy * hz * size * size * size * density;
        total += mass;
        box.push_back(add(world, mass, shape, btTransform(btQuaternion(qx, qy, qz, qw), btVector3(x, y, z)), mu));
    }
    std::clock_t begin = 0;
    int late = steps - steps / 10;
    for (int k = 0; k < steps; k++) {
        if (k == late) begin = std::clock();
        world.stepSimulation(dt, 1, dt);
    }
    double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC / (steps - late), energy = 0;
    for (const auto *b : box) {
        btVector3 w = b->getAngularVelocity();
        btMatrix3x3 inverse = b->getInvInertiaTensorWorld();
        energy += 0.5 / b->getInvMass() * b->getLinearVelocity().length2() + 0.5 * w.dot(inverse.inverse() * w);
    }
    std::printf("%.6g %.6g %.6g\n", seconds, energy, residual(world, mu, total / double(box.size()), dt));
    for (const auto *b : box) {
        btVector3 at = b->getCenterOfMassPosition();
        btQuaternion q = b->getOrientation();
        std::printf("%.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", at.x(), at.y(), at.z(), q.w(), q.x(), q.y(), q.z());
    }
    return 0;
}
