"""What the first runs taught, for the page: rules with the cases that set them."""

from __future__ import annotations

from proof.taught_since import SINCE

RULES = (
    (
        (
            "the best of the effects that the observation chose is judged as the best of all; impacts"
            " at the lines of several parts stand beside each other; a place whose effects lead all "
            "elsewhere is no unknown physics"
        ),
        "l093, s154",
    ),
    (
        (
            "a speed is doubted by the teeth; impacts at a single point must exceed what sound "
            "machines show; lines without a pattern count from 1e-4"
        ),
        "two sound machines that alarmed, l077, s106",
    ),
    (
        "a name is taken back where the machine with it, simulated, is no nearer to the recorded levels than without",
        "the sound l008 (3.92 dB of 3.49)",
    ),
    (
        "the place of an unknown force is told among supports alone",
        "l022, right by it",
    ),
    (
        (
            "phases between sensors are compared; a lead alone does not carry what fits worse than "
            "nearly all known effects and explains next to nothing"
        ),
        "l041",
    ),
    (
        "teeth refine the speed where they are sure",
        "l073: a line beside the shaft's own had led it 2.8 % away",
    ),
    (
        "single lines count at one operating point from three sensors on",
        "l077",
    ),
    (
        "what single lines make plausible is simulated too, in turn with what machines of the kind do",
        "l078, named before phases and unknown physics with them, is named again",
    ),
    (
        "the silence of what balls would strike counts where they strike another part for sure",
        'l056, l069: outer races named as inner ones ("Again"), since 41 before 26 and 37 before 27',
    ),
    (
        "a set whose best effect hardly stands out must come nearer by simulation, as a name must",
        'the sound s106 ("Sound"), since not decidable; l068 stays a set',
    ),
    (
        (
            "what impacts bring between the shafts' harmonics is noise upon lines of shafts and teeth "
            "([decision](decisions/reconcile-background.md))"
        ),
        "t008, lost to an eccentric gear by the phases of drowned sidebands; 45 before 32 since",
    ),
    (
        "what modulates the teeth at one frequency in Hz at every speed is no order, and unknown physics",
        "t016 and t032, a magnetic pull and a torque at twice the supply's frequency, which no one looked for",
    ),
    (
        "a sensor of which the gate is in doubt is left out where nothing known explains what it hears",
        "t030: beside a loose sensor the others had drifted by 3.6 dB in its band",
    ),
    (
        "a second effect is fitted together with the first ([decision](decisions/reconcile-pairs.md))",
        "t026, l016: one of two named, or a set; both since",
    ),
    (
        "a set carries 95 % of the weight, not 90",
        'f007 ("Fourth"): a wrong name 2.8 ahead of the right one',
    ),
    (
        (
            "the collision damping of a loose fit is searched "
            "([decision](decisions/reconcile-damping.md)); of two named effects the forecast is of both"
        ),
        "t034, f007 (held-out gains of 0.11 and 0.20, since 0.68 and 0.63), t026 (0.24 of one, 0.57 of both)",
    ),
    (
        (
            "lines that one sensor always heard do not hide that they have risen at another; only forms of one "
            "effect count together, not what cannot act beside it"
        ),
        "o002, an outer race 40 dB out of one envelope and unknown physics; o006, f007, named as supports that stiffen",
    ),
    (
        (
            "lines at multiples of a slow shaft are not its where these are usually empty: in 27 turns they cover half "
            "of all orders, and the ninth of this gear is the outer race"
        ),
        "u003, named as a ball's pit; u011, unknown physics (5.6 and 3.6 deviations of control lines, since 19 and 10)",
    ),
    (
        "what modulates the teeth at an order of no part, at two speeds or more, is unknown physics",
        "u013, a belt at 0.39 of the shaft's speed and nothing missing until then (5.0 dB, elsewhere 0.2)",
    ),
    (
        "a name beyond doubt stays where no simulated form of it is nearer, and its cause says so",
        "o016, a loose seat with 38.5 of evidence, 21 ahead, and not decidable",
    ),
    (
        "of two places with the same lines neither is named where the other forecasts better",
        "k021, a pit of one bearing named at the next (held-out gains 0.46 and 0.54; 18 of 19 right ones lead)",
    ),
    (
        "beside impacts one of several seconds needs what a second without impacts needs",
        "k006, a pit with one of six effects beside it, of which none was there",
    ),
    (
        "a frequency that stays in Hz may lie near a high multiple of a slow shaft; a strong line's top is flat",
        "k013, a torque at 100 Hz told as an order of no part; k004, the second turn of a broken tooth's gear as one",
    ),
    (
        "beside a sure pit the teeth's own lines tell ([decision](decisions/reconcile-beside-impacts.md))",
        "b018, a pit alone with a misaligned coupling beside it (15 by the metric, nothing by the teeth); b004",
    ),
    (
        "beside what does not strike a second must add 20; a pit that is half heard is asked too",
        "p015, a loose fit with an eccentric gear (14.7) where a pit was; n018, whose pit adds 37",
    ),
    (
        "sizes of a pit that most draws hide are simulated over their range; draws that crowd count once",
        "b018, 0.58 mm of 2.4 (held-out gain 0.22, since 0.39)",
    ),
    (
        "of three speeds one may be deaf to what modulates the teeth at one frequency in Hz",
        "a009, a torque at 100 Hz and nothing missing (10.9, 3.3 and 0.4 dB; sound ones of `third` up to 0.8 at two)",
    ),
    (
        "impacts that are sure are no other answer than a pattern that strikes nowhere, but stand beside it",
        "p011, a loose pedestal and a pit elsewhere: a set of the two and the pit's twin, since the pit beside it",
    ),
    (
        (
            "sizes of two effects are searched together where sums promise what simulation refuses"
            " ([decision](decisions/reconcile-sizes.md))"
        ),
        "b007, an unbalance 2.5 times too large that had swallowed a loose fit; since told beside it, one of three",
    ),
    (
        "beside what does not strike a second must add 30",
        "e038 and e068, a profile error and a loose pedestal, named with seconds that are not there (24 and 28)",
    ),
    (
        "without a baseline no physics is told as unknown",
        "q002, q015 and q023 of eight sound machines, run again on their tests alone",
    ),
    (
        (
            "of bearings that share their lines the one whose simulated defect, added to the baseline, is heard as the "
            "test is ([decision](decisions/reconcile-injected.md))"
        ),
        "e022, e043, e049 and e119, pits left open between two bearings, and e056, a pair with one; named since",
    ),
    (
        (
            "beside a force that turns, what may rattle is simulated whatever sums say "
            "([decision](decisions/reconcile-interplay.md))"
        ),
        "e145, e182 and e183, an unbalance with a loose fit or a worn bearing, of which the unbalance alone was told",
    ),
    (
        (
            "a channel that shares its noise with one that holds a line is not deaf "
            "([decision](decisions/reconcile-silence.md))"
        ),
        (
            "h001 and h025, loose fits that drowned every line above them at one speed: one named a pit; named since, "
            "with gains of 0.72 and, with the pit beside it, 0.66"
        ),
    ),
    (
        "what balls bring that pass under a play is no pit of that bearing; a second beside a play must lead by 12",
        "h001, a pitted outer race beside the loose fit (e143, a cracked shaft)",
    ),
    (
        "a pit of a bearing that fits best and strikes nowhere is no known effect",
        "h028, loose blows told as a pit of one of two kinds; unknown since, at the right bearing",
    ),
    (
        "of faults of a tooth beside another effect none is named unless the others are tried and far behind",
        "h021, a crack named a broken tooth beside a loose fit",
    ),
    (
        "lines alone tell of unknown physics from twice the usual on ([decision](decisions/reconcile-refused.md))",
        "the sound h034 and e127, the loose pedestals h062 and h107 and the loose fit e141, unknown before",
    ),
    (
        "what rises towards the teeth's lines is their skirt, no frequency of its own",
        "h100, an eccentric gear told as a modulation at 12 Hz",
    ),
    (
        (
            "impacts of a second effect count beside a play, but for those at the lines of the play's own bearing "
            "([decision](decisions/reconcile-second-rules.md))"
        ),
        "h035, a loose fit with a pit on the other shaft told beside an eccentric gear; both named since, gain 0.52",
    ),
    (
        "a broken and a pitted tooth of a gear are told together, and both are simulated where one is asked",
        "g007, a pit of most of a flank named a broken tooth; a set of both since, as is g010, which was right",
    ),
    (
        "groups of features alone claim no unknown physics where single lines are quiet",
        "g014, a crack whose machine had changed its regime by drift, unknown before",
    ),
    (
        "what stood out among all machines of the kind counts too where the whole change and single lines are unusual",
        "w012, a loose fit of 11 um that was not detected; named with its place since, 8.6 um (5 to 15)",
    ),
    (
        (
            "which of two like bearings is struck is asked of pits that a loaded ball meets "
            "([decision](decisions/reconcile-injected.md))"
        ),
        "w054, an outer race's pit told as a set of two places, named with its own since; w013 stays such a set",
    ),
    (
        "a wider clearance and a loose fit of one bearing are simulated as closely where either is the best",
        "w032, a loose fit of 11 um that was unknown physics; named with its place since, 13 um (7 to 24)",
    ),
    (
        (
            "second sidebands of a shaft count one by one, and a torque that comes twice a turn and an angle at a "
            "coupling are simulated as closely where either is the best "
            "([decision](decisions/reconcile-sidebands.md))"
        ),
        (
            "w003 and a005, angles at a coupling that were not decidable and not detected; the set of angle and torque "
            "at their shaft since, w003 with the angle first, 0.13 rad (0.07 to 0.22)"
        ),
    ),
    (
        (
            "a second effect takes no more than a quarter of what it adds at the other speeds, beside a play nothing "
            "([decision](decisions/reconcile-second-rules.md))"
        ),
        "w024, a loose fit of 36 um with waves of another bearing's race beside it that are not there; alone since",
    ),
    (
        (
            "a lead by patterns does not carry what leaves much of single lines where another effect is as likely, "
            "feature by feature; it comes behind one that leaves less "
            "([decision](decisions/reconcile-refused.md))"
        ),
        (
            "m009, a loose fit of 23 um told as a support that stiffens (held-out gain 0.30); named with its place "
            "since (0.50), 8.7 um (4.1 to 19)"
        ),
    ),
    (
        (
            "a second effect whose gain is one speed's alone adds twice as much as others must "
            "([decision](decisions/reconcile-second-rules.md))"
        ),
        "m008, an unbalance with a rub beside it that is not there; alone since",
    ),
    (
        "lines that a named effect takes away, as it is simulated, are no sign of exchanged recordings",
        "m006, a loose pedestal named rightly, beside which the recordings were told to be exchanged",
    ),
    (
        (
            "among pits of one bearing the one that is heard is named where the others would be and are not at all "
            "([decision](decisions/reconcile-silence.md))"
        ),
        "m024, an outer race's pit told as one of three of its bearing",
    ),
    (
        (
            "the burst of a tooth is no evidence against what moves the lines "
            "([decision](decisions/reconcile-mean-turn.md))"
        ),
        (
            "m038, a loose fit of 44 um beside a cracked tooth, told as the tooth's faults alone; the fit named since "
            "(0.33 held out), beside it a set of these"
        ),
    ),
    (
        "a fault of a tooth is as large as its burst says ([decision](decisions/reconcile-burst-size.md))",
        (
            "m033, w023, w035: cracks told as a tenth of what they are; within a fourth since, w001 and w067 too large "
            "by half"
        ),
    ),
    (
        (
            "a pit of a bearing is as large as its simulated impacts sound on the baseline "
            "([decision](decisions/reconcile-pit-size.md))"
        ),
        "m018, m024, m027, m031, m039, m047, w013, w054, w005, w018, h063 and h072: pits whose sizes set its weights",
    ),
    (
        (
            "what strikes nothing is as large as machines that agree with the baseline show at sizes about it "
            "([decision](decisions/reconcile-level-size.md))"
        ),
        "m006, m008, m009, m021, m034, m048, m055, m057, m059, m068 and m071: sizes that set its widths",
    ),
    (
        "of two pits both are sized by their impacts ([decision](decisions/reconcile-pit-size.md))",
        "y004, two pits named rightly and told as 1.9 and 1.6 times as wide",
    ),
    *SINCE,
)
"""What first runs taught: a rule, and the cases that set it."""
