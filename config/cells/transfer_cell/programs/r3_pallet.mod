%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%

! The arm mantec_R3 takes three parts from the places in front of it and lays them down side by side at the exchange.
MODULE r3_pallet
  CONST num lift:=150;    ! mm above a place
  CONST num pitch:=60;    ! mm between parts that are laid down
  CONST jointtarget home:=[[0,32.227,87.59,0,60.184,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget beside:=[[73.301,47.537,64.81,0,67.653,73.301],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget first_place:=[[-250,-900,450],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget exchange:=[[1000,-300,450],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR robtarget from_here;
  VAR robtarget to_there;

  PROC main()
    Reset do1;
    MoveAbsJ home,v5000,fine,tool0;
    FOR part FROM 0 TO 2 DO
      from_here:=Offs(first_place,250*part,0,0);
      to_there:=Offs(exchange,0,-pitch*part,0);
      take;
      MoveAbsJ beside,v5000,fine,tool0;
      lay_down;
      MoveAbsJ home,v5000,fine,tool0;
    ENDFOR
    TPWrite "r3_pallet has laid down three parts";
  ENDPROC

  PROC take()
    MoveL Offs(from_here,0,0,lift),v400,z40,tool0;
    MoveL from_here,v200,fine,tool0;
    Set do1;
    WaitTime 0.2;
    MoveL Offs(from_here,0,0,lift),v400,fine,tool0;
  ENDPROC

  PROC lay_down()
    MoveL to_there,v200,fine,tool0;
    Reset do1;
    WaitTime 0.2;
    MoveL Offs(to_there,0,0,lift),v400,fine,tool0;
  ENDPROC
ENDMODULE
