"""What docs/proof.md says of each stored run, and which of them are first runs."""

from __future__ import annotations

SECTIONS = {
    "engraver": "No version of the engine had met these before their run. Two ran at once. A second effect that would "
    "strike and does not repeat from speed to speed beside a play is searched with the sizes of both "
    "([decision](decisions/reconcile-second-rules.md)); these cases had no part in it.",
    "dyer": "No version of the engine had met these before their run. Two ran at once. Pits whose edges are both heard "
    "are sized by the angle between a ball's strikes ([decision](decisions/reconcile-strikes.md)), and a sure driving "
    "effect that leaves too much is asked for what it makes rattle ([decision](decisions/reconcile-interplay.md)); "
    "these cases had no part in it.",
    "chandler": "No version of the engine had met these before their run. Two ran at once, for some minutes beside a "
    "reader's short commands, which core-seconds show. What no drawing says of a loose ring is searched wider "
    "([decision](decisions/reconcile-rattle.md)); these cases had no part in it. Since then what leaves a little of a "
    "change needs more to be named by its forecast, by which no answer here is another (ch010, ch012, ch039 and ch065 "
    "were run again), and of two struck parts the one that is told says whether a play brings it.",
    "baker": "No version of the engine had met these before their run. Two ran at once, beside other work, which "
    "core-seconds show. The little that a likely effect leaves of lines is a remark beside its name, an order of no "
    "part that rose goes before a name that leaves the level change as it is, and rings that nothing speaks for are "
    "not all simulated ([decision](decisions/reconcile-refused.md), [decision](decisions/reconcile-leftover.md)); "
    "these cases had no part in it. Since then what no drawing says of a loose ring is searched wider, which bk001, "
    "bk059 and bk069 have set ([decision](decisions/reconcile-rattle.md)).",
    "twelfth": "No version of the engine had met these before their run: the plan but for tw002 by one engine. Two ran "
    "at once, beside other work, which core-seconds show. What changed for sure and is like nothing known is told as "
    "unknown physics ([decision](decisions/reconcile-refused.md)); these cases had no part in it.",
    "xenial": "No version of the engine had met these before their run. Two ran at once, beside other work, which "
    "core-seconds show. What sound machines may change is known from 144 simulated pairs for 48 "
    "([decision](decisions/reconcile-null-pairs.md)); these cases had no part in it. x001, x024, x032, x034, x043 and "
    "x045 have each set a rule since.",
    "zenith": "No version of the engine had met these before their run. Two ran at once, beside other work. Motion "
    "across the load that began as its mirror image is read the other way round "
    "([decision](decisions/reconcile-mirror.md)), and machines that take too many iterations are given up; these cases "
    "had no part in either. z022 and z023 were ended from outside with other processes and begun anew by the same "
    "engine. Since then many single samples far out are a fault of the measurement, one delay at all "
    "speeds is told by the teeth's own lines, and a sensor that failed takes no verdict from what the others show. "
    "z014, a heavy unbalance told as the pit of an inner race, and z009, knocks told as pits, have each set a rule: "
    "both are right since, which measures nothing.",
    "after": "No version of the engine had met these before their run: the rest of the plan `zenith`. Two ran at once, "
    "beside other work. Impacts once a turn of a shaft speak for an inner race of it by half of its own lines at most "
    "since z014, and a set of pits that nothing strikes in is none whatever is far behind them since z009; these cases "
    "had no part in either. Since then nothing is named with a chance above 0.001 "
    "([decision](decisions/reconcile-name-chance.md); z049, a sound machine that was), a pit beside a loose ring of "
    "its own bearing must be placed by what that leaves (z042), what drives a loose foot is searched with it (z068), "
    "and a set of faint pits that are not heard stays one (z053). Each is answered rightly since, which measures "
    "nothing.",
    "inquest": "No version of the engine had met these before their run: the whole plan by one engine. Two ran at "
    "once. It asks for a supply's frequency by less and at one speed, for a belt at one speed, and takes no name that "
    "forecasts nothing for sure; these cases had no part in any of it. i011, a loose ring, was given up by hand after "
    "nine minutes (a friction came first, and machines with both took five seconds each), and counts as wrong in all "
    "that applies; since then such machines are given up by themselves, and it is told as a set of three effects at "
    "its bearing. i050, a wide pit that nothing was heard of and that was told as unknown physics, has set a rule "
    "since.",
    "jury": "No version of the engine had met these before their run: the whole plan by one engine. Two ran at once. A "
    "sensor that changed at one operating point alone is left out and told "
    "([decision](decisions/reconcile-lone.md)), and sidebands near the teeth scatter with the wander of the speed as "
    "sound machines of earlier plans showed it; these cases had no part in either. Since then the engine was made "
    "faster, to the same values ([decision](decisions/reconcile-overhead.md)), and j053, the sound machine that "
    "alarmed, has set a rule: it is not decidable now. Eleven others were run again: no other answer has changed. "
    "j022, a loose sensor told "
    "as friction, j057, a pull of 100 Hz, and j071, a belt at one speed, have each set a rule after that.",
    "clear": "No version of the engine had met these before their run: the whole plan by one engine. Two ran at once, "
    "beside other work, which core-seconds show. It asks what rises together at a shaft's turns, and names a torque "
    "that comes many times a turn ([decision](decisions/reconcile-turns.md)); these cases had no part in either. c069 "
    "ended in an error: an effect's draws that show something were on no path of one view; the engine takes the "
    "nearest since. So the size of a torque that comes many times a turn is searched without sidebands that cannot be "
    "simulated, which no answer here had a part in.",
    "vast": "No version of the engine had met these before their run: the whole plan by one engine, which "
    "named what alone forecasts the speeds held out. Two ran at once, beside other work, which core-seconds show. That "
    "rule is taken back since ([decision](decisions/reconcile-forecasts.md)): it was asked in six of these cases, "
    "named v017 and v064 wrongly, and none rightly. v018, v040, v043 and v070 have each set a rule since.",
    "young": "No version of the engine had met these before their run: the whole plan by one engine. Two ran at once, "
    "beside other work, which core-seconds show. Sizes are told by the likelihood that draws about them have "
    "([decision](decisions/reconcile-level-size.md)), which these cases had no part in.",
    "mixed": "No version of the engine had met these before their run; one engine ran all of them, two or three at "
    "once on the two threads of one core that takes twice as long as that of `wide`, which core-seconds show. m040 (a "
    "backlash beside a cracked tooth) was begun and not waited for, beside two others; its worker had taken the even "
    'numbers, so m042, m044 and m046 were not run either. They are under "Resumed". '
    "m006, m008, m009, m024 and m038 have each set a rule since, by which m009, m024 and a part of m038 are named.",
    "resumed": "No version of the engine had met these before their run: m040, begun before and not waited for, and "
    "those that follow in the plan, all run by the engine of commit 1e2292b8, whose simulations take longer steps "
    "([decision](decisions/atlas-steps.md)). Other work shared the machine, which core-seconds show; those of m040 "
    "hold a part of three atlases. m052 has changed a sentence since: that something is missing is not said where "
    "groups of features alone are unusual.",
    "last": "No version of the engine had met these before their run: the next of the plan, all run by the engine of "
    "commit 003c9cf4 beside other work, which core-seconds show. Sizes of faulty teeth are measured by their burst "
    "since ([decision](decisions/reconcile-burst-size.md)); these cases had no part in that, and the cracks of m064 "
    "and m066 are told by levels here, as a tenth of what they are.",
    "closing": "No version of the engine had met these before their run: the last six of the plan, all run by the "
    "engine of commit f19aa093, two or three at once beside other work, which core-seconds show. Sizes of pits are "
    "measured by their impacts here ([decision](decisions/reconcile-pit-size.md)).",
    "present": "An engine before, on all cases of `mixed`: most of what they taught is in it, so these are no first "
    "meetings and stand in no figure of those. Two ran at once beside other work, which core-seconds show.",
    "wide": "No version of the engine had met these before their run; one engine ran all, beside other work on the two "
    "threads of one core, which core-seconds show. Since then unknown physics comes with its force by lines, and a "
    "change without a pattern is unknown physics again where no single lines could be asked (machines without teeth); "
    "no answer to these cases rests on either. w012, w024, w032 and w054 have set rules since.",
    "held": "No version of the engine had met these before their run; one engine ran all (h035 was run a second "
    "time, as the engine was frozen again; its first answer was not looked at). Two ran at once on the two threads of "
    "one core, beside other work, which core-seconds show. Since then the rules of the sensor gate on dead, loose and "
    "clipped sensors have changed, what is told beside a play, and when unknown physics is: h034, h035, h062, h100 and "
    "h107 have each had a part in a rule.",
    "begun": "No version of the engine had met these before their run: the first 34 of `held` and h086, all run by the "
    "engine before (commit 3f03490). h001, h021, h025 and h028 have each set a rule since.",
    "entire": "No version of the engine had met these before their run; one engine ran all of them. Two ran at once on "
    "the two threads of one core, beside other work, which core-seconds show.",
    "hearing": "No version of the engine had met these before their run: the other cases of `entire` without atlases "
    "of their own, all run by one later engine (commit ece7897), which was not changed between them. Other work shared "
    "the machine, which core-seconds show.",
    "teeth": "No version of the engine had met these before their run: the last eleven of the split made for faults of "
    "teeth (the first five stand under what is missing against the plan), all run by one engine (commit 763372c5), the "
    "latest but for the rule that g007 has set since: a broken and a pitted tooth are told together, by which g010 too "
    "is a set. Three ran at once on two threads.",
    "fresh": "No version of the engine had met these before their run.",
    "third": "No version of the engine had met these before their run; all at the target condition.",
    "repeat": "The same 36, all of which had been looked at: t008, t016, t030 and t032 have each set a rule.",
    "fourth": "No version of the engine had met these before their run; all at the target condition. Ten of the "
    "eighteen have two effects, of laws that mostly show. Other work shared the machine while these ran, which "
    "core-seconds show: one that ended with nothing missing took 133.",
    "unmet": "No version of the engine had met these before their run; all at the target condition, pairs of laws that "
    "mostly show. Run when the collision damping of a fit was first searched.",
    "renewed": "The same eighteen once lines at multiples of a slow shaft had been looked for: u003 and u011 have set "
    "that rule, u013 the next one since.",
    "next": "No version of the engine had met these before their run; all at the target condition, pairs of laws that "
    "mostly show. Run when orders of no part had first been looked for.",
    "others": "No version of the engine had met these before their run: two other nominal machines than the paper's "
    "(`proof/nominals.py`: supports half as stiff, eight balls, module 2.5 mm; eleven balls, module 1.5 mm, a light "
    "load), all at the target condition. Core-seconds of the first case of each machine hold its three atlases. The "
    "six of a third machine had been run before, by an engine of the day: two of four named with place, one sound "
    "machine quiet, one not decidable; two of them have set rules.",
    "kinds": "No version of the engine had met these before their run: two further gearboxes (`proof/nominals.py`: "
    "shafts that turn nearly alike, with bearings of ten balls; heavy, with coarse teeth and bearings of twelve), all "
    "at the target condition, the faintest severities left out. Core-seconds of each machine's first case hold its "
    "three atlases, those of k014 another three: its torque is its own. k004, k006, k013 and k021 have each set a rule "
    "since: the last, a pair, was named with its pit at the wrong one of two bearings.",
    "beside": "No version of the engine had met these before their run; all at the target condition, pairs of laws "
    "that mostly show. Run when second effects were first found by what the fitted first one leaves "
    "([decision](decisions/reconcile-leftover.md)). Other work shared the machine. The single pit of b018 got a second "
    "name that is not there, by the metric, fitted together with it; its width, and b015's, are told a quarter of "
    "what they are.",
    "anew": "No version of the engine had met these before their run; all at the target condition, pairs of laws that "
    "mostly show. Run when recordings of other rigs had been gone through, with the engine at machine level as it was "
    "since `pitted`. Of the fourteen single effects five move the spectrum hardly more than drift does, or less (a002, "
    "a003, a005, a017, a024). a009, a torque at 100 Hz that shows at two speeds of three, has set a rule since.",
    "pitted": "What stands beside a pit: nine pairs, four single pits, a broken tooth and a sound machine, all at the "
    "target condition. Pits are easier than the plan's effects, so these are not counted among the first runs above. "
    "No version of the engine had met twelve of them before; p001, p002 and p003 had been run by the one before sizes "
    "of pits were spread, whose results were thrown away unread. Run when the teeth's own lines were first asked "
    "beside pits ([decision](decisions/reconcile-beside-impacts.md)), with limits of 8 and 3, since 12 and 6, which "
    "changes no answer: what was named beside a pit an older rule named. Laws and levels of pairs go in step, seven of "
    "each, so races are not to be compared by them; effects that no library has are not among them. p015, a loose fit "
    "and a pit that is hardly heard beside it, got an eccentric gear for the pit; since a second must add 20 there it "
    "is named alone, with impacts from another part told as one of two places of the pit.",
    "rotors-later": "No version of the engine had met these before their run: two machines without teeth, a disc of 5 "
    "and of 9 kg on a shaft in two bearings, alike and unlike (`proof/rotors`), loaded by weight and shaken by a "
    "residual unbalance; all at the target condition. Not counted among the gearboxes above. An unbalance and a bow of "
    "the disc load its bearings alike at every speed, so the set of both, said of r110, is all that can be told.",
    "rotors": "The 22 rotors with which single lines of such machines, their speeds and their gate were developed "
    "([decision](decisions/reconcile-rotors.md)): none is met for the first time.",
    "quiet": "No version of the engine had met these before their run: forty sound machines at the target condition, "
    "sealed to count false alarms, run in two parts. Other work shared the machine.",
    "lone": "No version of the engine had met these before their run: one sensor, 20 dB at one speed or 10 dB at "
    "three, nine of the ten with one sensor that were left.",
    "crossing": "No version of the engine had met these before their run: five speeds with one, three and eight "
    "sensors at 30, 10 and 20 dB, twelve of the split's fifteen. l008 and l022 have each set a rule since.",
    "phases": "No version of the engine had met these before their run: one speed and three sensors at 30 dB, one or "
    "three speeds and eight sensors, and one pair at the target condition. l041 and l073 have each set a rule since.",
    "again": "The same 28 with the engine that compares phases and nominates by single lines too: none is met for the "
    "first time; l056, l069 and l093 have each set a rule.",
    "seen": "Of those looked at before, the ones that were run again: one that an earlier engine got right, six not.",
    "sound": "Cases in which nothing is missing, at all conditions of up to three speeds. All had been looked at; s106 "
    "has set two rules.",
    "further": "Not met before by the engine of that day; l044 and l048 are at the target condition.",
    "rerun": 'The five of "Further" with the later engine, two rules of which came from l077 and s106.',
    "alone": "These had been looked at before this run; there is no baseline, or the nominal machine is mis-set.",
    "later": "",
    "sealed": "",
    "dev": "Cases for development.",
}
"""Of the page, each from one stored summary: of a split, or of a part of one."""
FIRST_RUNS = (
    "fresh",
    "third",
    "fourth",
    "unmet",
    "next",
    "others",
    "kinds",
    "beside",
    "anew",
    "lone",
    "crossing",
    "phases",
    "further",
    "quiet",
)
"""Sections whose cases no engine had met before, of the plan's mix of effects."""
HISTORY = {
    "fresh": ('l052 to l094 ("Fresh")', "and nulls that the metric has not seen"),
    "third": ("t001 to t036 (split `third`)", "and phases, silence, nomination by lines"),
    "fourth": ("f001 to f018 (split `fourth`)", "and two effects fitted together"),
    "unmet": ("u001 to u018 (split `unmet`)", "and the damping of a fit searched"),
    "others": ("o007 to o018 (split `others`)", "and lines of slow shafts counted"),
    "next": ("n001 to n020 (split `next`)", "and orders of no part"),
    "kinds": ("k001 to k024 (split `kinds`)", "and speeds refined"),
    "beside": ("b001 to b020 (split `beside`)", "and seconds found by what is left"),
    "anew": ("a001 to a025 (split `anew`)", "and the teeth asked beside pits"),
}
"""First runs with single effects at the target condition: their cases, and what the engine of their day could."""
TAKEN_DOWN = (16, 55)
"""Single effects that the first six rows of the history name with their place, and how many there were."""
