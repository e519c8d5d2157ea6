"""nsd-fit: parameters of a scene that repeat measurements [nsd-fit(1)].

problem.py      the file that names parameters, command and targets
table.py        evaluations: they run, and each is kept as soon as it is made
surrogate.py    Gaussian processes of the measures, and the posterior of the parameters
report.py       the values with their intervals, what the targets cannot determine, the plot
command.py      a run: batches of evaluations until the intervals stay
options.py      the command line, which needs Python alone
"""
