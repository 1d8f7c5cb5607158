// Printed listings: the sample programs 9.1 to 9.10 of the manual, letter by letter as its text has them [L7617-8340], comments included.
// In: nothing. Out: their texts, to be downloaded as they stand.
// Never repaired: what is wrong in them is wrong here.
#pragma once

#include <array>
#include <string_view>

namespace axisgate::mcode::test {

struct PrintedListing {
    std::string_view name;
    std::string_view fault;  ///< what a check of it says; empty: good
    std::string_view text;
};

// clang-format off
inline constexpr std::array printed_listings{
    PrintedListing{"9.1", "", R"MC(\ [VARIABLES]
\ This block contains the global variable and system
\ configuration information.

Is=1,0,0
Ms=256
Vi=200000
Vm=2500000
A=1000000
D=A
Hc=2
Rc=75
P=0

\ [PROGRAMS]
\ The program block for this application sets the event
\ that triggers the subroutine call when input 1 is active
\ and loops when I1=inactive

PG 1
LB Ga      \Program execution label
P=0
LB G1      \Loop back label
  CL Kb,I1=1
  H 10
  BR G1
E

\ Subroutine from trigger event will execute a ten
\ revolution positive move, hold, then return to 0 in the
\ negative direction and repeat as long I1=1

LB Kb      \subroutine label
  MA 512000
  H
  MA 0
  H
  RT
PG          \exit program
S
\ Keep this line to save program on load
\ [END]
)MC"},
    PrintedListing{"9.2", "line 16: D: 8000000000 is not allowed", R"MC(\ [VARIABLES]
\ This block contains the global variable and system
\ configuration information.
Hc=20
Rc=100

\ [PROGRAMS]
PG 1
\ Program label Ga sets local variables and register
\ values. These are re-initialized each time the program
\ is executed.
LB Ga
Vi=20000
Vm=500000
A=500000
D=8000000000
R1=0
R2=0

\ Label Gx sets the trip response and Performs Register
\ Math to print final position
LB Gx
P=0
Tp=51200,Kb
Te=2
SL 101200
H
H 250
IC R1
R2=R2+P
BR Gx,R1<10
R2=R2/100
PR "Average end pos = ",R2
E

\ [SUBROUTINES]
\ Subroutine Kb, when called by Tp=51200 increases the
\ axis velocity by 50%
LB Kb
SL 202400
Tp=102290,Kc
Te=2
RT

\ Subroutine Kc, when called from Kb ends the motion
\ sequence
LB Kc
SL 0
H
RT

PG
S
\ Keep this line to save program on load
\ [END]
)MC"},
    PrintedListing{"9.3", "", R"MC(\ [VARIABLES]
\ Define I/O configuration
Is=1,0,0
Is=2,0,0
Is=3,0,0
Is=4,0,0
Os=1,16,0

\ Set up system variables
Vi=20000
Vm=1000000
A=500000
D=A
Hc=20
Rc=75

\ [PROGRAMS]
\ The main program block is labeled SU `a keyword which
\ will execute the program on power up.

PG 1
LB Su
  P=0

\ The block G1 will call various subroutines based upon
\ the weight of the inputs which is stored in register R1

LB G1
  R1=In
  R1=R1 & 7
  O1=0
  CL K0,R1 = 0
  CL K1,R1 = 1
  CL K2,R1 = 2
  CL K3,R1 = 3
  CL K4,R1 = 4
  CL K5,R1 = 5
  CL K6,R1 = 6
  CL K7,R1 = 7
  H 10
  BR G1
  E

\ [SUBROUTINES]
\ These 8 routines will rotate the motor
\ 1 time for each input bit and repeat
\ the input weight changes

LB K0
  PR "Logic 000"
  MR R1*51200
  H
  O1=1
  H 2000
  RT

LB K1
  PR "Logic 001"
  MR R1*51200
  H
  H 200
  RT

LB K2
  PR "Logic 010"
  MR R1*51200
  H
  H 200
  RT

LB K3
  PR "Logic 011"
  MR R1*51200
  H
  H 200
  RT

LB K4
  PR "Logic 100"
  MR R1*51200
  H
  H 200
  RT

LB K5
  PR "Logic 101"
  MR R1*51200
  H
  H 200
  RT

LB K6
  PR "Logic 110"
  MR R1*51200
  H
  H 200
  RT

LB K7
  PR "Logic 111"
  MR R1*51200
  H
  H 200
  RT

PG
S
`Keep this line to save program on load

`[END]
)MC"},
    PrintedListing{"9.4", "", R"MC(\ [VARIABLES]
Rc=80
Mt=50

\ HMT off and encoder functions enabled and configured
As = 0
Ee=1
Sf=15
Sm=0

\ motion variables are scaled to encoder counts instead of
\ microsteps
A=20000
D=A
Vi=2048
Vm=15000

\ user variable created to hold move count
VA Q1

\ [PROGRAMS]
\ program block Ga sets the on error handle routine to
\ call K1
PG 1
LB Ga
    OE K1
    P=0

\ program block Gb contains the motion loop which will run
\ 100 times
LB Gb
    MR 51200
    H
    H 500
    MR -51200
    H
    H 500
    IC Q1
    BR Gb,Q1<100
    CL K1
E

\ [SUBROUTINES]
\ Subroutine K1 sets the response for the on-error
\ handler. It will perform some math to determine the
\ position error in encoder counts, as well as display the
\ error # if one occurs.
LB k1
    R3=C1/25
    R1=R3 - C2
    PR "Counts error = ",R1
    PR "Error = ",Er
    Er=0
    H 20
    RT

PG
S
\ Keep this line to save program on load
\ [END]
)MC"},
    PrintedListing{"9.5", "", R"MC(`[VARIABLES]
`System configuration variables
Ms=256
Vi=200000
Vm=2500000
A=1000000
D=A
Hc=10
Rc=75

`Globally defined user variables to contain
`input data
VA K1=0
VA K2=0
VA K3=51200
VA K4=0

`[PROGRAMS]
`Program labeled Su will start on power on
`or software reset. Will zero the position
`counter and wait 2 sec before dropping to
`program block Z1
PG 1
  LB Su

  P=-0
  PR "At Home Position"
  H 2000

  `Block will request a number of desired
  `revolutions and insert the number into
  `variable K1
  LB Z1
    PR "Enter the number of revolutions in whole numbers"
    IV K1
    LB X1
    BR X1, If=1
    H 50

  `Block will request a direction of
  `rotation and insert the number into
  `variable K2, then call the appropriate
  `subroutine with error checking for
  `invalid entries

  LB X4
    PR "Enter rotation direction (0) neg. (1) pos."
    IV K2
    LB X2
    BR X2, If=1
    H 50
    BR Y1,K2=0
    BR Y2, K2=1
    PR "Invalid Entry"
    BR X4

`X6 will print the final position of the axis
`to the terminal screen
LB X6
  VA K5
  K5=P/K3
  PR "Axis position is ", K5, " absolute from home"
  H 3000

`Block X5 will initiate following the commanded
`move with an option to re-run or quit
LB X5
  PR "Repeat program (1) or quit (0)"
  IV K4
  LB X3
  BR X3, If=1
  BR Z1, K4=1
  BR Z2, K4=0
  PR "Invalid Entry"
  BR X5

`[SUBROUTINES]
`The following branch routines will
`calculate the move distance and
`direction and execute the move
LB Y1
  MR -K3*K1
  H
  BR X6

LB Y2
  MR K3*K1
  H
  BR X6

`[END]
LB Z2
PR "Program Ended"
E
PG
S
`Keep this line to save program on load
)MC"},
    PrintedListing{"9.6", "line 23: DL is no word", R"MC(\ [VARIABLES]
\ Global variable declarations
Ee=1
Vm=4096
Vi=Vm/50
A=20480
D=A
Hc=50
Rc=50
Mt=50

\ Encoder setup

Sf=20
Sm=0
Db=5

\ I/O setup
Is = 1, 1, 0 \Homing input
Is = 2, 0, 1 \General purpose input
Os = 1, 17, 1 \Moving output
Os = 2, 18, 1 \Error output
Dl=100

\ [PROGRAMS]
\ Main program will home in mode 1 Slew minus @ VM until
\ to find home switch then creep plus @ VI

PG 1
LB G1
  H 1000
  PR C1 ,C1
  PR C2 ,C2
  Pm=1
  PR "Position counter: " C1
  PR "Encoder counter: " C2
  H 5000
  HM 1
  H
  P=0

\ After homing, motor will move @ 7186 steps each move
\ printing position each time
LB G2
  BR G2,I2=1
  MR 7186
  H
  PR "Position: " P
  BR G2

E
PG
S
\ Keep this line to save program on load on load
)MC"},
    PrintedListing{"9.7", "", R"MC(`Lexium Motion Module DEMO PROGRAM
`Last modified 12/13/12

`[VARIABLES]
VA Q1
D1=255

`[PROGRAMS]
`Program will run a motion
`profile on an input toggle
PG 1
LB G1
  Ti = 1, X1
  Te = 1
  LB G2
  Q1 = 0
  BR G2
E

`Motion profile
LB X1
  IC Q1
  MR 51200
  H
  MR -51200
  H
  BR X1, Q1 < 4
  Te = 1
  RT
  E
PG      ` End of Program
S
`Keep this line to save program on load
)MC"},
    PrintedListing{"9.8", "", R"MC(`Lexium Motion Module DEMO PROGRAM
`Last modified 12/14/12

`[VARIABLES]
VA Q1 = 0
VA Q2 = 0
D1 = 255
D2 = 255

`HMT off, encoder enabled
As=0
Ee=1

`[PROGRAMS]
`Program stores a +/- move p profile based on encoder
`counts set by manually positioning the motor shaft
`An input toggle stores the encoder counts to a user
`variable.

PG 1
LB Su
  Er = 0
  C2=0
  Q1 = 0
  O2 = 0
  PR "Move motor to position 1"
  PR "Toggle switch 1 when ready"
LB X1
  BR X1, I1 = 0
  Q1 = C2
  PR Q1
LB X2
  BR X2, I1 = 1
  PR "Move motor to position 2"
  PR "Toggle switch 1 when ready"
LB X3
  BR X3, I1 = 0
  Q2 = C2
  PR Q2
LB X4
  BR X4, I1=1
  PR "Toggle Sw 2 to start cycle"
LB X5
  BR X5, I2 = 0
  LB X6
  MA Q1
  H
  PR P
  H 250
  MA Q2
  H
  PR P
  H 250
  BR X5

E
PG           ` End of Program
S
`Keep this line to save program on load
)MC"},
    PrintedListing{"9.9", "", R"MC(\Lexium Motion Module DEMO PROGRAM
\Last modified 12/14/12

\[VARIABLES]
Os = 1, 20, 1 `Velocity changing output
A=2000000
D=2000000
R4=80

\[PROGRAMS]
\The main program block calls
\subroutine to calculate a slew rate
\based on the value of I5
PG 1
LB G1
  R1 = I5
  CL Z1
  SL R3
  H 10
  BR G1
E

\Subroutine performs calculation
\to vary the velocity based upon
\the analog input
LB Z1
  R1 = R1-2032
  R2 = 1
  BR Z2, R1>=0
  R2 = -1
  R1 = R1 * R2

LB Z2
  BR Z3, R1<R4
  R1 = R1 * 625
  R3 = R1 * R2
RT

LB Z3
  R3=0
RT

E
PG
S
\Keep this line to save program on load
)MC"},
    PrintedListing{"9.10", "", R"MC(`Lexium Motion Module DEMO PROGRAM
`Last modified 12/13/12

`[VARIABLES]
As=0
Ee=1
Sf=30

`[PROGRAMS]
`Main program will assign
`a register to do math on the value of the analog
`input and slew the register value. An on-error event
`calls a subroutine to register stall
PG 1
LB Su
  OE X1
  Er=0
  R1=I5
  R1=R1*50
  SL R1
  PR V
  H 250
  BR Su
E

`[SUBROUTINES]
`on error routine
LB X1
  PR "Error! " Er
LB Y1
  BR Y2,Er <> 86
  PR "Stall"
LB Y2
  Er=0
E
PG                               ` End of Program
S
`Keep this line to save program on load
)MC"},
};
// clang-format on

}  // namespace axisgate::mcode::test
