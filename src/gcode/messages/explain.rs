//! The long story of each diagnostic: one text for each code.

/// Code, title, story.
#[rustfmt::skip]
const STORIES: &[(&str, &str, &str)] = &[
    ("G101", "A character that starts no word",
        "G-code is letters with numbers, comments and a few signs. Anything else is most often a dash or a quotation \
         mark of a word processor, a letter of another alphabet, or a piece of prose. Type it anew in plain ASCII, \
         or put it in a comment."),
    ("G102", "A letter without its number",
        "Every word is a letter and a number: X12.5. A letter alone says nothing, and controls differ in what they \
         make of it: some take 0, some stop. Write the number, or take the letter out."),
    ("G103", "A number that cannot be read",
        "A number has one sign at most, in front, and one decimal point at most. 1.2.3, 5-3 and --5 have no sure \
         value."),
    ("G104", "A number beyond any machine",
        "No word carries more than a thousand million: such a number comes from a calculation that failed, or from \
         lost blanks between two numbers."),
    ("G105", "An exponent",
        "G-code has no exponents, and E is an axis or a pitch on some controls, so that 1.5e3 would be read as two \
         words. Write all digits."),
    ("G106", "NaN or infinity",
        "A post processor writes these words where a calculation failed. The error is in the part model or in the \
         post processor, not in this line."),
    ("G107", "A number without a letter",
        "It belongs to no word. A blank inside a number does this, X1 0 for X10; so does a letter that was lost."),
    ("G108", "A comment that does not end",
        "A parenthesis closes on its own line. What stands behind it would be lost without notice, so that it is an \
         error."),
    ("G109", "Variables where there are none",
        "The paper's dialect reads no variables: fanuc, haas and linuxcnc do, and siemens R parameters behind an equals sign. Write the \
         value itself, or choose the dialect of the control."),
    ("G110", "Block delete inside a block",
        "The slash is a switch for a whole block and stands at its beginning. In other places some controls divide \
         by it, others skip the rest: neither is done here."),
    ("G111", "A percent sign among words",
        "The percent sign opens and closes a tape. It stands alone on its line."),
    ("G112", "A block that is too long",
        "No control reads blocks of this length. The file is no program, or its line ends were lost in a transfer."),
    ("G113", "No text",
        "A zero byte stands in no text file. The file is a binary one or encoded in UTF-16: save it as ASCII or \
         UTF-8."),
    ("G114", "Text outside of a comment",
        "Letters in a row are no words. Text goes into parentheses or behind a semicolon."),
    ("G115", "A jump in a stream",
        "Line by line, a program cannot go back to a line that is gone. Loops, jumps and subprograms are read where \
         the whole source is given."),
    ("G116", "An expression that cannot be read",
        "Values are numbers, variables (#1, #<name>), brackets with operators between, and functions with their \
         argument in brackets. Every bracket has its partner. ATAN takes two values: ATAN[y]/[x]."),
    ("G117", "A variable that is not known",
        "fanuc has the local variables #1 to #33 and the common ones #100 to #199 and #500 to #999; linuxcnc has #1 \
         to #5000. Of the system variables the position is read: #5001 to #5003, #5021, #5041, in linuxcnc #5420. The others reach into a real machine's state, which is not here."),
    ("G118", "A name without a value",
        "A named parameter has a value once it was assigned one. A name that begins with an underscore is common to \
         all subprograms, any other is known in its own alone: this is where such names get lost."),
    ("G119", "A value that cannot be computed",
        "Division by zero, the root of a negative number, an arc sine beyond one, or a result beyond the range of \
         numbers."),
    ("G120", "An expression nested too deep",
        "Nobody reads forty brackets inside each other. Compute parts of it into variables."),
    ("G121", "A statement that cannot be read",
        "fanuc reads IF [ ] GOTO n, IF [ ] THEN #i = value, GOTO n, WHILE [ ] DO m and END m with m from 1 to 3; \
         linuxcnc reads O words: sub, call, return, if, elseif, else, while, do, repeat, break, continue and their \
         ends."),
    ("G122", "Text behind the end of the block",
        "On a FANUC and a Haas the semicolon is the end of the block, not the beginning of a comment: what stands behind it is another block on some ways into the control, and lost on others. linuxcnc and siemens take it as a comment."),
    ("G123", "An address with a number of its own",
        "S2=500 and M2=3 belong to a second spindle. The machine here has one."),
    ("G124", "An R parameter that is written and read in one block",
        "Whether the reading has the old value or the new one is nothing to rely on. In R1=R1+1 it is the old one."),
    ("G201", "An unknown code",
        "The dialect has no meaning for it, and a code that is passed over may be the one that mattered. Leave it \
         out where it is not needed, or choose the dialect of the control the program was written for."),
    ("G202", "A number that is no code",
        "Codes are 0 to 999.9 with one decimal at most."),
    ("G203", "An unknown letter",
        "The dialect gives this letter no meaning. A word that is passed over may be the one that mattered."),
    ("G204", "A word that stands twice",
        "Controls take the first or the last one, and differ in which."),
    ("G205", "A code that stands twice",
        "It does no harm on most controls and is an error on some. Keep one."),
    ("G206", "Codes that exclude each other",
        "Codes of one modal group replace each other, so that of two in one block only one can hold. Controls differ \
         in which."),
    ("G207", "A line number inside the block",
        "N is the first word of its block."),
    ("G208", "Two counts of repeats",
        "K and L both count how often a hole is repeated."),
    ("G209", "A word without effect",
        "Nothing in this block or in force acts on the word. What does nothing was meant to do something."),
    ("G210", "A code that changes nothing simulated",
        "Coolant, tool changes, stops for the operator and switches of the panel do not move an axis that taps. Each \
         is reported once, so that nobody waits for an effect."),
    ("G211", "A word that changes nothing simulated",
        "Z is the tap's tip, whatever tool and length are chosen: numbers of tools, edges and lengths change \
         nothing."),
    ("G212", "A cycle that is not known",
        "Of SINUMERIK's cycles CYCLE84 is read, by itself and modal with MCALL, and HOLES1 and HOLES2 under it. SPOS \
         stops the spindle at an angle, from which G331 starts; SUPA is this block's machine coordinates. A name alone, and L10, call the subprogram in the \
         file of that name, NAME.SPF, in the program's folder or those of --subprograms; parameters are not handed over."),
    ("G213", "A parameter that cannot be read",
        "Parameters of CYCLE84 are numbers, sums or R parameters with commas between, and one that is left out is nothing between two \
         commas. Variables in them are not read."),
    ("G214", "A parameter that does not fit",
        "CYCLE84's parameters: 1 RTP retraction plane, not below the R plane; 2 RFP reference plane; 3 SDIS safety \
         distance; 4 DP depth; 5 DPR depth from RFP; 6 DTB dwell; 7 SDAC spindle after the cycle, 3, 4 or 5; 8 MPIT size \
         M3 to M48 of the coarse series; 9 PIT pitch, which must be that of MPIT where both are given; 10 POSS angle at which \
         the spindle rests on the R plane, [gcode] start_angle_deg where it is left out; 11 SST speed in; 12 SST1 speed out; 13 AXN axis, 0 or 3; 14 PITA unit of PIT, 0 as in force, 1 mm, 2 \
         threads per inch, 3 inch; 15 TECHNO; 16 VARI, 0 one stroke, 1 chip break, 2 full retract; 17 DAM peck; 18 VRT \
         distance back; 19 to 21 texts; 22 GMODE, 0; 23 DMODE plane, 0 or 1 (G17); 24 AMODE, digits from the right: \
         depth (1 DPR, 2 DP), dwell (1 seconds, 2 revolutions), 0, hand (1 right, 2 left; then the pitch is positive), \
         0, 0, 0 or 1. The depth lies below the R plane, which is RFP plus SDIS; a size or a pitch is needed."),
    ("G215", "A cycle without parameters",
        "CYCLE84 holds all that the hole needs in its parentheses. MCALL alone ends a modal call."),
    ("G216", "A code without effect",
        "Nothing in this block acts on the code: G53 in a canned cycle is the usual one. What does nothing was meant to do something, and controls differ in what."),
    ("G217", "A word of a cycle where no hole is made",
        "A FANUC stores R, Z, P and Q in blocks that drill alone; a Haas drills where X or Y stands; LinuxCNC refuses the word. The next hole would not be as the word says."),
    ("G218", "An argument without its decimal point",
        "An argument of G65 without a point counts the least increments of its address: Z10 may be 0.010. Controls and addresses differ; write the point."),
    ("G219", "A name that changes nothing simulated",
        "Look-ahead, feedforward, smoothing, kinds of acceleration, texts for the operator and what the screen shows move no hole. Each is reported once."),
    ("G220", "A frame",
        "TRANS, ROT, SCALE and MIRROR with axes move every later position. They are not read; alone they end what is never on."),
    ("G221", "A parameter that changes nothing simulated",
        "The parameter is read, and neither the hole nor its strokes depend on it here."),
    ("G222", "Two depths",
        "CYCLE84 takes the depth from RFP (DPR) where both are given and no AMODE says which, as the control does; it shows a message there, too."),
    ("G223", "A pattern without a cycle",
        "HOLES1 and HOLES2 make the hole of the modal cycle at each of their positions. Without MCALL they only move."),
    ("G224", "A parameter of a pattern that does not fit",
        "The sixth parameter counts the holes, from 1; parameters beyond it are not read unless they are zero."),
    ("G225", "A cycle beside other words",
        "A SINUMERIK calls a cycle or a subprogram in a block of its own. Axes, F, S and M codes in that block are refused by the control, and whether they would act before the hole or after it is not said anywhere."),
    ("G301", "Nothing says how to move",
        "G80 ended the cycle, or nothing was said yet. Controls begin with G0 or G1 by a parameter: say it."),
    ("G302", "No feed",
        "A tap's pitch comes from F: F/S under G94, F itself under G95. A change between the two asks for F anew, \
         for a speed is no pitch."),
    ("G303", "A feed that is not above zero",
        "The thread's hand comes from M03 or M04, or from G84 and G74, not from the sign of F."),
    ("G304", "F without its decimal point",
        "Where numbers without a point count increments, F1 of a pitch may be a hundredth of a millimetre or a whole \
         one, by parameter. Write the point."),
    ("G305", "A negative spindle speed",
        "Backwards is M04."),
    ("G306", "A feed per revolution without revolutions",
        "Under G95 the axis moves with the spindle, and the spindle stands."),
    ("G307", "A spindle code without speed",
        "M03 turns nothing as long as there is no S."),
    ("G308", "A length counted in increments",
        "A Fanuc reads X10 as ten increments, ten micrometres, and X10. as ten millimetres. A lost point is the \
         oldest way of breaking a tap. Write every point, or set decimal_point = \"calculator\" in the machine file \
         where the control does so (parameter 3401 bit 0)."),
    ("G309", "A work offset that changes nothing",
        "All work offsets have their zero in one place until G10 L2 writes another. Real machines keep theirs in a \
         table that this program does not see, so that holes of several offsets lie over each other here."),
    ("G310", "A pause without time",
        "G4 takes P: milliseconds on a Fanuc, seconds in LinuxCNC; a Fanuc takes X in seconds too, a SINUMERIK F."),
    ("G311", "Machine coordinates under G91",
        "G53 is a position in the machine's own coordinates, which a distance is not. A Fanuc passes over it under \
         G91."),
    ("G312", "An offset that is not known",
        "G10 L2 P1 to P6 writes G54 to G59; in linuxcnc also P7 to P9, P0 for the one in force, and L20."),
    ("G313", "A shift without axes",
        "G52 and G92 move the coordinates by the axes they name."),
    ("G314", "Another reference point",
        "G30 goes to the second, third or fourth reference point, by P. Where they lie only the machine knows; the first one is taken, and what follows should name every axis."),
    ("G315", "The motion of power on",
        "Nothing has said G0 or G1 yet. A Haas, and a FANUC as delivered, then move at rapid. Where the tool goes is the same either way."),
    ("G316", "A position that G16 or G68 leaves open",
        "Polar coordinates (G16: X the radius, Y the angle about the work offset's zero) and a turned plane (G68 X Y R) are \
         read where controls agree: under G90, with the centre and the angle said, in one work offset. Distances under \
         G16, machine coordinates, the reference point, and shifts of the offset under either depend on the control's \
         parameters."),
    ("G317", "An angle without a point",
        "Y of G16 and R of G68 are degrees. On a FANUC and its kin a number without its point counts thousandths, so that \
         30 is 0.03°."),
    ("G318", "A hole without its tool length",
        "G43 added the tool's length to Z and G49 took it away again: on the control the next Z goes to the spindle's nose, deeper by the whole length of the tool. Here Z is the tip whatever the length, so that the hole looks right. A program that never says G43 has its length in the work offset and is not told."),
    ("G401", "A tap without direction",
        "The thread's hand is the spindle's: M03 cuts a right-hand thread, M04 a left-hand one."),
    ("G402", "A tap without speed",
        "There is no S, or it is zero."),
    ("G403", "A cycle without its level",
        "R is where the synchronous strokes begin and end, Z the bottom of the hole."),
    ("G404", "A bottom that is not below R",
        "Under G90 both are positions. Under G91 R counts from the initial level and Z from the R plane."),
    ("G405", "A count of repeats that is none",
        "Repeats are whole numbers. Zero stores the cycle's data on a Fanuc and is an error in LinuxCNC."),
    ("G406", "More repeats than a control takes",
        "At most 9999 in one block."),
    ("G407", "The same hole again",
        "Repeats step by X and Y under G91 alone: under G90 every repeat taps the hole that is there."),
    ("G408", "A negative dwell",
        "A dwell is a time."),
    ("G409", "A dwell with a decimal point",
        "P counts whole milliseconds here. A point is a sign that seconds were meant, as in LinuxCNC."),
    ("G410", "A pitch that changed with S",
        "Under G94 the pitch is F/S. A new S with the old F cuts another thread, which is seldom meant."),
    ("G411", "Hand against spindle",
        "G84 cuts a right-hand thread and G74 a left-hand one, and the spindle was commanded to turn the other way. Some \
         controls stop, some break the tap."),
    ("G412", "A tapping cycle that may not be rigid",
        "On a Fanuc G84 is a tap in a floating holder unless M29 stands before it, or parameter 5200 bit 0 makes \
         every G84 rigid. It is taken as rigid here."),
    ("G413", "A negative peck",
        "Q is the depth of one peck and has no sign. Some controls pass over the sign, others stop."),
    ("G414", "A return speed that is not above zero",
        "J is the spindle's speed of the stroke out on a Fanuc, and a factor on a Haas; I is a factor in G33.1."),
    ("G415", "A stroke without pitch",
        "G33.1 and G331 take the pitch from K in their own block."),
    ("G416", "A pitch that is of no use",
        "A pitch is above zero. On a SINUMERIK the sign is the thread's hand."),
    ("G417", "A stroke that moves sideways",
        "Z alone follows the spindle in a rigid tap."),
    ("G418", "A stroke that does not go down",
        "The stroke in begins where Z stands, which is the R plane, and ends below."),
    ("G419", "A stroke out without its stroke in",
        "G332 turns a tap out that G331 turned in."),
    ("G420", "A stroke in without its stroke out",
        "After G331 the tap is in the part: any other move breaks it."),
    ("G421", "Two pitches in one thread",
        "Out runs in the thread that in has cut."),
    ("G422", "A stroke out that ends in the hole",
        "The next move would not be synchronous, and the tap still in the thread."),
    ("G423", "A pitch that nearly is a standard one",
        "Nobody makes taps of 0.98 mm. The pitch differs from a metric or inch one by more than rounding, and by \
         less than three percent: F or S is mistyped, or F was rounded too coarsely. Half a thread turn of error in \
         a deep hole is enough to strip it."),
    ("G424", "A cycle that turns the other way",
        "A rigid cycle on a FANUC or Haas stops the spindle and turns it in its own hand, whatever M03 or M04 said before. The tap is cut as the G code says: see whether that is what was meant."),
    ("G425", "A cycle without a position",
        "In LinuxCNC the code of a cycle stands with X, Y or Z; alone it is an error."),
    ("G426", "Zero repeats with a position",
        "K0 stores the data of the cycle and makes no hole. Whether the control moves to X and Y of its block its manual does not say. What is counted from there, or leaves an axis out, would be placed by chance."),
    ("G427", "A unit that changed under a cycle",
        "R and Z of an earlier block were written in the other unit. Some controls keep the length, some keep the number: say them anew."),
    ("G428", "A dialect from memory",
        "What this control does was written down without its manual at hand. Each table that names manual and page reports nothing."),
    ("G429", "Two pitches",
        "Two words of one block give the pitch, and only one can hold."),
    ("G430", "A tap that is not synchronous",
        "With ,R0 the axis follows the feed and not the spindle. Only synchronous tapping is simulated."),
    ("G431", "A pitch finer than any thread",
        "The finest pitch of ISO 261 is 0.2 mm. Mostly F is the pitch itself under G94, where it is a speed, or an inch program has no G20."),
    ("G432", "A pitch of taper threads",
        "27 and 11 1/2 threads per inch are of NPT (ASME B1.20.1), whose taper of 1 in 16 makes the tap cut along its whole \
         length: torque and tolerance of a cylindrical thread do not hold."),
    ("G433", "A rule from memory",
        "Nearly every rule of the dialects names the text that it was found in, or the test that holds it against the control. This one does not: what the control makes of it was written down from memory, and a hole depends on it."),
    ("G501", "An empty program",
        "There is no word in the file."),
    ("G502", "A program without end",
        "Neither M30 nor M02, nor a closing percent sign: the file may have been cut in a transfer. LinuxCNC refuses \
         it."),
    ("G503", "Text behind the end",
        "It is not read. A program number behind the end, O1000, begins a subprogram and is no such text."),
    ("G504", "Too many findings",
        "The first hundred are shown. Most follow from a few: mend these and check again."),
    ("G505", "A jump to a block that is not there",
        "GOTO names the number of a block, N, in the same program. It is looked for from the jump on, then from the \
         program's start."),
    ("G506", "A program that is not in the file",
        "M98 calls a program by the number behind its O. Subprograms stand in the same file, behind M30, or each in a \
         file of its number, O1000.nc, in the program's folder or in one of --subprograms."),
    ("G507", "A subprogram that is not in the file",
        "An O word calls a subprogram that stands in the same file between sub and endsub."),
    ("G508", "A call that names no program",
        "M98 takes the number in P, and how often in L; or both in P: P30001 runs O0001 three times."),
    ("G509", "A loop or condition without its partner",
        "Every beginning has its end with the same number or name, in the same program."),
    ("G510", "Calls or loops nested too deep",
        "A subprogram that calls itself never ends."),
    ("G511", "A loop that does not end",
        "After a quarter of a million blocks that ran again the program is given up. Controls would run it for ever."),
    ("G512", "Millions of commands from repeats",
        "A repeat makes few bytes into many holes. A program may have any number of blocks, but beyond two million \
         commands that only its repeats make something else was meant, and reading ends there."),
    ("G513", "A second program in the file",
        "One file is one run, from its first program on. A program behind the end runs where M98 or G65 calls it; this one is not called, so that none of its holes is tapped."),
    ("G514", "A number of a program that can be read in two ways",
        "On a FANUC with programs of four digits P40008 runs O0008 four times, on one with more digits it runs O40008 once. The file has both."),
    ("G515", "Two counts of one call",
        "On a FANUC P of more than four digits holds a count and the number. L beside it counts, too, and controls differ in which holds."),
    ("G516", "A count of calls that is none",
        "L says how often a subprogram runs: a whole number above zero."),
    ("G517", "A program for another control",
        "A line with an error has what one other control alone writes. Under its dialect the program may be read."),
    ("G601", "A hole without depth",
        "The bottom is not below the R plane."),
    ("G602", "A number the planner cannot use",
        "A speed, a pitch, a dwell or a travel is not positive and finite."),
    ("G603", "A speed beyond the spindle",
        "S, or J, is more than spindle.max_rpm of the machine file."),
    ("G604", "A pitch too fast for Z",
        "Z follows with pitch times speed, and that is more than z.max_mm_per_s. A lower S with the same pitch is \
         what helps."),
    ("G605", "A pitch too sharp for Z",
        "Z follows with pitch times the spindle's acceleration, and that is more than z.max_mm_per_s2. The law is \
         slowed for such a hole (G703); this one would need less than a hundredth of it."),
    ("G606", "A stroke without time law",
        "The law has no profile for this distance and speed: mostly a stroke shorter than the law's start and end \
         speeds need."),
    ("G607", "Too many pecks",
        "Fifty pecks a hole are the limit. A greater Q takes fewer."),
    ("G608", "A thread whose tolerance is not known",
        "The verdict needs a tolerance. For the usual threads it follows from the pitch or from --tap; elsewhere give \
         [tolerance] error_um."),
    ("G609", "A thread whose tap is not known",
        "The cutting torque needs the tap's and the hole's diameters. For the usual threads they follow from the pitch or from \
         --tap; elsewhere give [tap] major_mm and hole_mm."),
    ("G610", "A program that takes days",
        "More than 100 hours of planned motion: some coordinate, feed or dwell is wrong by orders of magnitude. The block \
         shown is the one at which the time is passed."),
    ("G611", "A pitch that is not the tap's",
        "The machine file or --tap names the tap in the spindle, and F and S make another pitch. Such a hole strips its \
         thread or breaks the tap."),
    ("G701", "A speed that is not reached",
        "The stroke is too short for the spindle to come to S and to rest again. The peak is what the tap sees, and \
         cycle time no longer falls with S. A lower S costs nothing, and spares the spindle the turn."),
    ("G702", "A cutting speed beyond the material",
        "The speed of the tap's circumference is beyond what the material bears with usual coated taps. The tap \
         wears out, or welds."),
    ("G703", "A law that is slowed for a hole",
        "Z follows with pitch times the spindle's acceleration, and that is more than z.max_mm_per_s2 at this pitch. The \
         hole is planned with the law's accelerations, jerks and share of the motor times this factor; other holes keep \
         the law as it is. Through the C interface and in the core such a hole is refused."),
];

/// Every code there is, in order.
pub fn codes() -> impl Iterator<Item = &'static str> {
    STORIES.iter().map(|(code, ..)| *code)
}

/// The long story of a code, in either case: what is meant, and why it matters.
///
/// ```
/// use rigidtap::gcode::explain;
/// assert!(explain("g423").unwrap().starts_with("G423: A pitch that nearly is a standard one"));
/// assert_eq!(explain("G999"), None);
/// ```
#[must_use]
pub fn explain(code: &str) -> Option<String> {
    let (code, title, story) = STORIES.iter().find(|(known, ..)| known.eq_ignore_ascii_case(code))?;
    Some(format!("{code}: {title}\n\n{story}\n"))
}
