MODULE M
  CONST robtarget p1:=[[600,100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveC p1,p1,v100,fine,tool0;
    ConfL\Off;
    AccSet 50,50;
    WaitUntil di1=1;
    GOTO again;
    MovL p1,v100,fine,tool0;
    SetDo1 do1,1;
    GripLoad load0;
    MoveK p1;
    WaitTme 1;
    PulseDO do1;
    Frobnicate 1,2;
  ENDPROC
ENDMODULE
