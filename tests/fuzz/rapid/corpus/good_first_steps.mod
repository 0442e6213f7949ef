%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%

MODULE Shelf
  CONST jointtarget home:=[[0,-30,30,0,60,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget above:=[[600,100,400],[0,0,1,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget box:=[[600,100,250],[0,0,1,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];

  PROC main()
    MoveAbsJ home,v1000,fine,tool0;
    MoveJ above,v500,z10,tool0\WObj:=wobj0;
    MoveL box,v100,fine,tool0;
    Set do1;
    WaitTime 0.5;
    MoveL above,v200,z5,tool0;
    MoveAbsJ home,vmax,fine,tool0;
    TPWrite "box taken";
  ENDPROC
ENDMODULE
