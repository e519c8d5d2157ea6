"""The distribution of contact forces of a solved document, solved.h5: a histogram, forces.png."""
import matplotlib.pyplot as plt
import numpy as np
import nsd
contacts = nsd.last("solved.h5").contacts      # made by nsd-solve, or by nsd-step --contacts
f = np.linalg.norm(contacts.force, axis=1)     # N; contacts.force has vectors
f = f[f > 0] / f[f > 0].mean()
plt.hist(f, bins=np.arange(0, 8, 0.25), density=True, log=True)
plt.xlabel("force / mean force")
plt.ylabel("probability density")
plt.savefig("forces.png")
